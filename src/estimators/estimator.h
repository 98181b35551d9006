#pragma once

#include "image/pass_image.h"
#include "image/pixel_window.h"
#include "math/stop_token.h"
#include "transport/world.h"
#include "vdbeam/render.h"

#include <memory>

namespace vdbeam {

class PhotonCache;

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

/// What every estimator is made from; the references must outlive it.
struct EstimatorInput {
  const World& world;
  const Camera& camera;
  std::uint64_t frame = 1;
  /// Pixels that are wanted; empty: all. Others may stay black.
  PixelWindow window = {};
  const StopToken* stop = nullptr; ///< tells when the pass is to be abandoned
  PhotonCache* photons = nullptr;  ///< of frames with the same world; null: photons are not kept

  /// The same in another world, which must outlive the result too.
  EstimatorInput in(const World& other) const {
    return {other, camera, frame, window, stop, photons};
  }

  bool stopped() const { return stop && stop->stopped(); }
};

/// The table of estimators: what `render.estimator` names.
std::unique_ptr<Estimator> make_estimator(EstimatorType type, const EstimatorInput& input);

} // namespace vdbeam
