#pragma once

#include <cstddef>
#include <cstdint>

namespace vdbeam {

/// Seconds and counts of a render, by stage.
struct RenderStatistics {
  double read = 0;    ///< volumes: file to bricks; 0 where the last frame's were kept
  double prepare = 0; ///< majorants, lights
  double pilot = 0;   ///< measurements and choices before the first pass
  double build = 0, trace = 0, order = 0, radii = 0, query = 0, profile = 0, direct = 0, path = 0,
         bias = 0, write = 0;
  std::uint64_t light_paths = 0, photons_stored = 0, contributions = 0, camera_rays = 0;
  std::uint64_t lookups = 0;          ///< rays or points gathered from the photon map
  std::uint64_t depth_profiles = 0;   ///< camera rays whose optical depth was integrated
  std::uint64_t shadow_rays = 0;      ///< of camera rays' single scattering
  std::uint64_t emission_rays = 0;    ///< camera rays along which emission was integrated
  std::uint64_t light_collisions = 0; ///< of light paths, where photons could be stored
  std::uint64_t camera_walks = 0;     ///< random walks from camera rays (path)
  std::uint64_t walk_collisions = 0;  ///< tentative collisions of these and of their shadow rays
  std::uint64_t walk_shadow_rays = 0; ///< shadow rays of the walks from camera rays (path)
  std::uint64_t gather_walks = 0;     ///< walks from camera rays to where photons are gathered
  std::uint64_t neighbourhoods = 0;   ///< photons whose radius follows their neighbours'
  std::uint64_t bias_rays = 0;        ///< camera rays path traced to estimate the bias
  std::uint64_t directions = 0;       ///< photons stored with their direction
  std::uint64_t maps_reused = 0;      ///< passes whose photons were those of an earlier frame
  std::uint64_t pilot_paths = 0;      ///< light paths traced before the first pass, to plan photons
  std::uint64_t importance_rays = 0; ///< rays that measured the importance of places for the camera
  std::uint64_t grids_read = 0;      ///< of volumes' files; not those that were kept
  std::uint64_t meshes_read = 0, textures_read = 0; ///< files; not those that were kept
  std::uint64_t trees_built = 0;                    ///< of Embree, over shapes
  std::uint64_t peak_memory = 0;                    ///< bytes, whole process
  std::size_t bytes_per_photon = 0;
  double neighbours = 0; ///< photons in an adaptive kernel, as given or chosen
  /// Light removed by render.clamp: sums of radiance over passes, pixels and channels; clamped
  /// pixels of all passes.
  double clamp_removed = 0, clamp_total = 0;
  std::uint64_t clamped_pixels = 0;

  /// Adds another's seconds and counts; keeps the greater of values that are no sums.
  RenderStatistics& operator+=(const RenderStatistics& other);
  /// Fraction of the image's light that render.clamp removed.
  double clamped_fraction() const { return clamp_total > 0 ? clamp_removed / clamp_total : 0; }
};

} // namespace vdbeam
