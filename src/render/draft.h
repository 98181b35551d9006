#pragma once

#include "choose/pass_renderer.h"
#include "render/frame_setup.h"
#include "transport/camera_ray.h"

#include <memory>

namespace vdbeam {

/// The same scene in fewer pixels, of the same shape together, and without what drafts leave out:
/// layers, deep samples and motion.
Scene reduced(const Scene& scene, int reduction);

/// Renders a whole picture in little time: passes of the scene in fewer pixels, enlarged. The light
/// of the medium changes slowly per opacity, and that of a surface changes slowly over it, so both
/// are interpolated, and so are the shares of groups of lights; opacity, depth, the lights behind,
/// coverage and planes of layers are computed for every pixel of the picture. A draft leaves out
/// layers of the light of single volumes, deep samples and motion.
class Draft {
public:
  /// Whether a draft can show all that a scene asks for, but for motion.
  static bool can_show(const Scene& scene);

  /// Prepares a draft of the pixels of `window` in the raster, in 1 / `reduction` of them each way.
  /// Runs the pilots.
  /// What is given must outlive this.
  Draft(const Scene& scene, const PreparedScenePtr& prepared, const PixelRegion& window,
        int reduction, const StopToken& stop);
  ~Draft();

  /// False where it was stopped; then nothing was added.
  bool add_pass();
  int passes() const { return passes_; }
  int reduction() const { return reduction_; }
  double pilot_seconds() const { return pilot_seconds_; }
  double pass_seconds() const { return pass_seconds_; } ///< of the last pass

  /// Makes the mean of the passes ready to be enlarged; requires a pass.
  void look_through();
  /// The mean in a part of the window of `full`, the same scene's input, as an image of that part's
  /// size. Several threads may ask. Pixels are left out after a request of `full` to stop.
  PassImage enlarged(const EstimatorInput& full, const PixelRegion& part) const;

private:
  struct Seen;
  struct Around;
  struct Place;
  Around around(const Place& place, int surface) const;
  void enlarge(const EstimatorInput& full, const Place& place, CameraRay ray, std::size_t pixel,
               DepthProfile& profile, PassImage& image) const;
  void share_among_groups(const Place& place, int surface, std::size_t pixel,
                          PassImage& image) const;

  ImageSettings picture_; ///< that is enlarged to
  Scene scene_;           ///< of the draft
  int reduction_;
  PixelRegion window_; ///< of the draft
  std::unique_ptr<FrameSetup> setup_;
  std::unique_ptr<PassRenderer> renderer_;
  PassImage sum_;
  std::vector<Seen> seen_; ///< per pixel
  /// By group, then pixel: the light of the medium and of surfaces, without the lights behind.
  std::vector<std::vector<Rgb>> group_light_;
  int passes_ = 0;
  double pilot_seconds_ = 0, pass_seconds_ = 0;
};

} // namespace vdbeam
