#include "estimators/estimator_table.h"

namespace vdbeam {

std::unique_ptr<Estimator> make_estimator(const EstimatorType& type, const EstimatorInput& input) {
  return estimator_kind(type).make(input);
}

} // namespace vdbeam
