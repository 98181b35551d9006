#include "estimators/estimator_table.h"

#include <array>

namespace vdbeam {

// This list stands alone in its file, so that a program may link another in its place.
std::span<const EstimatorKind* const> estimator_table() {
  static constexpr std::array table{&auto_estimator, &beam_estimator, &gather_estimator,
                                    &march_estimator, &path_estimator};
  return table;
}

} // namespace vdbeam
