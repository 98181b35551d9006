#include "keys/estimator_kind.h"

#include "vdbeam/error.h"

#include <fmt/format.h>

namespace vdbeam {

const EstimatorKind& estimator_kind(const EstimatorType& type) {
  for (const EstimatorKind* kind : estimator_table())
    if (kind->name == type.name)
      return *kind;
  throw InputError(fmt::format("render.estimator: there is no estimator \"{}\"", type.name));
}

} // namespace vdbeam
