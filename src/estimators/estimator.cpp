#include "estimators/estimator.h"

#include "estimators/beam.h"
#include "estimators/march.h"
#include "estimators/path.h"
#include "vdbeam/error.h"

namespace vdbeam {

std::unique_ptr<Estimator> make_estimator(EstimatorType type, const EstimatorInput& input) {
  switch (type) {
  case EstimatorType::path:
    return std::make_unique<PathEstimator>(input);
  case EstimatorType::beam:
    return std::make_unique<BeamEstimator>(input);
  case EstimatorType::march:
    return std::make_unique<MarchEstimator>(input);
  }
  throw InputError("unknown estimator");
}

} // namespace vdbeam
