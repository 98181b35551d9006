#pragma once

#include "medium/depth_profile.h"
#include "photonmap/beam_tile.h"
#include "rays/estimator_input.h"
#include "transport/camera_ray.h"

#include <array>
#include <span>
#include <vector>

namespace vdbeam {

/// The camera rays of one 16 x 16 tile of a pass, with their depth profiles. Ray 16 s + r is ray r
/// of the 4 x 4 sub-tile s (both row-major), as BeamTile orders them. Rays beyond the image's edge
/// repeat their neighbour's direction and have empty profiles.
class TileRays {
public:
  static constexpr int count = BeamTile::ray_count;
  static constexpr int across = 16; ///< rays along each side
  /// The ray of the tile's pixel (x, y), both counted from its upper left one, and the reverse.
  static constexpr int ray_at(int x, int y) { return 16 * (y / 4 * 4 + x / 4) + y % 4 * 4 + x % 4; }
  static constexpr int column(int ray) { return ray / 16 % 4 * 4 + ray % 4; }
  static constexpr int row(int ray) { return ray / 64 * 4 + ray % 16 / 4; }

  /// One jittered ray per pixel of the tile whose upper left pixel is (x0, y0), and its profile.
  void prepare(const EstimatorInput& input, const RngKey& key, int x0, int y0);

  struct PixelRay {
    CameraRay camera;
    EyeRay eye; ///< the ray in double precision
    DepthProfile profile;
    std::size_t pixel = 0;
    std::size_t stream = 0; ///< of the ray's random numbers
    bool inside = false;    ///< the pixel exists
  };
  /// Rays of a pixel that has been refined, its own among them.
  static constexpr int rays_if_refined = 4;
  /// One pixel's ray, jittered, without its profile; `number`: which of its rays. Together they lie
  /// on a lattice in the pixel, and each is distributed as if it were alone.
  static PixelRay pixel_ray(const EstimatorInput& input, const RngKey& key, int x, int y,
                            int number = 0);

  const PixelRay& operator[](int ray) const { return rays_[ray]; }

  /// Adds rays to the pixel of a ray.
  void refine(const EstimatorInput& input, const RngKey& key, int ray);
  /// Contribution of the refinement to the pixel of a ray; empty if it was not refined.
  std::span<const PixelRay> more(int ray) const;
  /// Whether any of its own rays ends at a surface.
  bool show_surface() const;
  int x0() const { return x0_; }
  int y0() const { return y0_; }

private:
  std::array<PixelRay, count> rays_;
  std::vector<PixelRay> more_;          ///< kept from tile to tile for the memory of their profiles
  std::size_t used_ = 0;                ///< of them, in this tile
  std::array<int, count> first_more_{}; ///< of each ray; -1: none
  int x0_ = 0, y0_ = 0;
};

} // namespace vdbeam
