#pragma once

#include "estimators/camera_ray.h"
#include "estimators/estimator.h"
#include "photonmap/beam_tile.h"
#include "transport/depth_profile.h"

#include <array>

namespace vdbeam {

/// The camera rays of one 16 x 16 tile of a pass, with their depth profiles. Ray 16 s + r is ray r
/// of the 4 x 4 sub-tile s (both row-major), as BeamTile orders them. Rays beyond the image's edge
/// repeat their neighbour's direction and have empty profiles.
class TileRays {
public:
  static constexpr int count = BeamTile::ray_count;

  /// One jittered ray per pixel of the tile whose upper left pixel is (x0, y0), and its profile.
  void prepare(const EstimatorInput& input, const RngKey& key, int x0, int y0);

  struct PixelRay {
    CameraRay camera;
    EyeRay eye; ///< the ray in double precision
    DepthProfile profile;
    std::size_t pixel = 0;
    bool inside = false; ///< the pixel exists
  };
  /// One pixel's ray, jittered, without its profile.
  static PixelRay pixel_ray(const EstimatorInput& input, const RngKey& key, int x, int y);

  const PixelRay& operator[](int ray) const { return rays_[ray]; }
  int x0() const { return x0_; }
  int y0() const { return y0_; }

private:
  std::array<PixelRay, count> rays_;
  int x0_ = 0, y0_ = 0;
};

} // namespace vdbeam
