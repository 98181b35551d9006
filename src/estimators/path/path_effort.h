#pragma once

#include "medium/medium.h"
#include "vdbeam/render_statistics.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vdbeam {

/// The parts of a camera ray's light that `path` draws several times for each ray.
enum class PathPart : std::uint8_t { scattered_once, walks, surface };
inline constexpr std::size_t path_part_count = 3;

/// How often a ray draws a part: the part counts `weight` times each.
struct PartDraws {
  int count = 0;
  float weight = 0;
};

/// How often `path` draws each part for a ray that sees nothing but that part.
struct PathEffort {
  static constexpr int most = 32;
  std::array<float, path_part_count> draws{4, 4, 4};

  float& of(PathPart part) { return draws[static_cast<std::size_t>(part)]; }
  /// For a ray to which a part can contribute the fraction `share`: one draw at least, but where
  /// the share is not seen; `u`, uniform in [0, 1), decides there.
  PartDraws draws_of(PathPart part, float share, float u) const;
};

/// What a pilot measures of the parts, with one draw of each for each ray.
struct PathTrial {
  struct Part {
    double variance = 0; ///< sum of the weighted variance of a draw, per share of the part
    double time = 0;     ///< sum of a draw's time [ns] times the share
  };
  std::array<Part, path_part_count> parts;
  double ray_variance = 0; ///< sum over the rays of the weighted variance that no draw changes
  double ray_time = 0;     ///< and of the time that every ray takes [ns]

  PathTrial& operator+=(const PathTrial& other);
  /// The draws with the least variance times time: with V_0 and C_0 per ray and V_i / n_i and C_i
  /// n_i for the parts, n_i^2 = (V_i / C_i) / (V_0 / C_0), as for optimal splitting (Bolin and
  /// Meyer 1997, "An error metric for Monte Carlo ray tracing"). A pilot does not see rare, bright
  /// paths, so each part takes at least `least_time` times the time of the ray itself.
  PathEffort best_effort(double least_time = 1) const;
};

/// The time of a shadow ray [ns]: layers, whose optical depth has a closed form, take less than
/// voxels.
double time_of_shadow_ray(const Medium& medium);

/// The time of the shadow rays and walks of `path` that were counted [ns], without that of the
/// camera rays themselves.
double time_of_paths(const Medium& medium, const RenderStatistics& counts);

} // namespace vdbeam
