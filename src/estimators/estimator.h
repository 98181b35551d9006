#pragma once

#include "rays/estimator_input.h"

#include <memory>

namespace vdbeam {

/// Renders independent passes of one frame. A pass is a pure function of (scene, seed, frame, pass
/// number), whatever the threads.
class Estimator {
public:
  virtual ~Estimator() = default;

  /// Renders pass `pass` (from 0) into `image`, which is resized; adds to `statistics`. Where the
  /// input's `stop` asked to end meanwhile, only `image.finished_tiles` hold what the pass is to
  /// be.
  virtual void render_pass(int pass, PassImage& image, RenderStatistics& statistics) = 0;
};

/// The estimator that `render.estimator` names. Throws InputError for one that there is not.
std::unique_ptr<Estimator> make_estimator(const EstimatorType& type, const EstimatorInput& input);

} // namespace vdbeam
