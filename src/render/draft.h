#pragma once

#include "choose/pass_renderer.h"
#include "render/frame_setup.h"
#include "transport/camera_ray.h"

#include <memory>

namespace vdbeam {

/// A whole picture in little time: passes of the scene in fewer pixels, enlarged. What the medium
/// scatters is smooth per opacity, and what surfaces send out is smooth on each of them; opacity,
/// depth and lights behind are those of every pixel of the picture. Layers, groups, deep and motion
/// are left out.
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

  /// The mean of the passes, of which there must be one, in the pixels of `full`, the same scene's
  /// input. Pixels that are beyond its window stay empty.
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
