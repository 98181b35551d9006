#pragma once

#include "choose/pass_renderer.h"
#include "render/frame_setup.h"
#include "transport/camera_ray.h"

#include <memory>

namespace vdbeam {

/// Renders a whole picture in little time: passes of the scene in fewer pixels, enlarged. The light
/// of the medium changes slowly per opacity, and that of a surface changes slowly over it, so both
/// are interpolated; opacity, depth and the lights behind are computed for every pixel of the
/// picture. A draft leaves out layers, groups, deep samples and motion.
class Draft {
public:
  /// In 1 / `reduction` of the pixels each way. Runs the pilots. What is given must outlive this.
  Draft(const Scene& scene, const PreparedScenePtr& prepared, int reduction, const StopToken& stop);

  /// False where it was stopped; then nothing was added.
  bool add_pass();
  int passes() const { return passes_; }
  int reduction() const { return reduction_; }
  double pilot_seconds() const { return pilot_seconds_; }
  double pass_seconds() const { return pass_seconds_; } ///< of the last pass

  /// The mean of the passes in the pixels of `full`, the same scene's input; requires a pass.
  /// Pixels beyond its window stay empty.
  PassImage enlarged(const EstimatorInput& full) const;

private:
  struct Seen;
  struct Around;
  std::vector<Seen> look_through() const;
  Around around(const std::vector<Seen>& seen, double x, double y, int surface) const;
  void enlarge(const EstimatorInput& full, const std::vector<Seen>& seen, double x, double y,
               CameraRay ray, std::size_t pixel, DepthProfile& profile, PassImage& image) const;

  Scene scene_;
  int reduction_;
  std::unique_ptr<FrameSetup> setup_;
  std::unique_ptr<PassRenderer> renderer_;
  PassImage sum_;
  int passes_ = 0;
  double pilot_seconds_ = 0, pass_seconds_ = 0;
};

} // namespace vdbeam
