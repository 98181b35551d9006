#pragma once

#include "image/pass_image.h"
#include "layers/scene_motion.h"
#include "medium/depth_profile.h"
#include "transport/camera_ray.h"

namespace vdbeam {

/// The planes of a pass beyond its light, opacity and depth, and what each camera ray adds to them.
class RayLayers {
public:
  /// Those that the scene's layers ask for.
  RayLayers(const Scene& scene, const Velocities& velocities);
  /// The same at a moment of the shutter's time.
  RayLayers at(const Scene& moment) const;

  std::size_t planes() const { return names_.size(); }
  const std::vector<std::string>& names() const { return names_; }
  /// Layers of volumes are among them.
  bool tells_volumes() const { return tells_volumes_; }
  /// The plane of a volume's blue light (A, B, G and R are in this order); -1: none.
  int volume_plane(std::size_t setting) const { return volume_planes_[setting]; }
  /// Light adds up over groups of lights; all else is the same for each of them.
  bool is_light(std::size_t plane) const;
  /// They hold the light on shadow catchers that the plate does not have.
  bool tells_added_light() const { return added_ >= 0; }

  /// The medium along a ray, as seen by the camera.
  struct Seen {
    Rgb left;       ///< what the medium lets through of the light behind
    float depth;    ///< what the ray adds to PassImage::depth
    float shadow;   ///< opacity of the shadow catcher at the ray's end
    Rgb plate_left; ///< the share of the plate's light that arrives there
    Rgb added;      ///< its radiance by light that the plate does not have
  };
  /// Adds the values of a ray to the planes, but for the light of volumes (RaySink).
  void record(const World& world, const CameraRay& camera, const DepthProfile& profile,
              const Seen& seen, std::size_t pixel, PassImage& image) const;

private:
  class Planes;
  float record_surface(const World& world, const CameraRay& camera, const Seen& seen,
                       const Planes& planes) const;
  void record_pieces(const World& world, const CameraRay& camera, const DepthProfile& profile,
                     const Planes& planes) const;
  void record_features_of_surface(const World& world, const CameraRay& camera, float behind,
                                  const Planes& planes) const;
  int find(const std::string& name) const;

  std::vector<std::string> names_;
  /// First planes; -1: none.
  int near_, far_, position_, motion_, gradient_, albedo_, normal_, holdout_, shadow_, added_;
  std::vector<int> volume_planes_; ///< by volume of the scene
  bool tells_volumes_ = false;
  std::optional<SceneMotion> scene_motion_;
};

/// Adds light that volumes scatter or emit towards a pixel to their layers; does nothing where
/// nobody asks for those.
class VolumeLights {
public:
  VolumeLights() = default;
  VolumeLights(const RayLayers* layers, std::size_t pixel, PassImage& image)
      : layers_(layers && layers->tells_volumes() && !image.planes.empty() ? layers : nullptr),
        pixel_(pixel), image_(&image) {}
  explicit operator bool() const { return layers_ != nullptr; }

  /// `setting`: which volume of the scene it is.
  void add(std::size_t setting, const Rgb& light) const {
    const int plane = layers_ ? layers_->volume_plane(setting) : -1;
    for (int c = 0; plane >= 0 && c < 3; ++c)
      image_->planes[static_cast<std::size_t>(plane + 2 - c)][pixel_] += light[c];
  }

private:
  const RayLayers* layers_ = nullptr;
  std::size_t pixel_ = 0;
  PassImage* image_ = nullptr;
};

} // namespace vdbeam
