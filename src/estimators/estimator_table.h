#pragma once

#include "estimators/estimator.h"
#include "keys/estimator_kind.h"

namespace vdbeam {

extern const EstimatorKind auto_estimator, beam_estimator, march_estimator, path_estimator;

} // namespace vdbeam
