#include "medium/bounded_tracking.h"

#include "medium/optical_depth.h"

#include <limits>

namespace vdbeam {

namespace {

/// Where the optical depth from t_a on is `tau`, in a piece of the ray between two lattice planes
/// that ends at t_b: by bisection, since the depth grows with t and is cheap to have.
float distance_at_depth(const Volume& volume, const Ray& ray, float t_a, float t_b, float tau) {
  constexpr int halvings = 24; // of a float's digits
  float low = t_a, high = t_b;
  for (int i = 0; i < halvings; ++i) {
    const float middle = 0.5f * (low + high);
    (cube_optical_depth(volume, ray, t_a, middle) < tau ? low : high) = middle;
  }
  return high;
}

Collision exact_collision(const Volume& volume, const Segment& segment, Rng& rng) {
  float left = -std::log(rng.uniform_positive());
  Collision hit;
  for_each_piece(volume, segment, [&](float t_a, float t_b, float tau) {
    if (tau < left) {
      left -= tau;
      return true;
    }
    hit.t = distance_at_depth(volume, segment.ray, t_a, t_b, left);
    hit.volume = &volume;
    return false;
  });
  if (hit.volume) {
    constexpr float least = std::numeric_limits<float>::min(); // their ratio is 1, not 0 / 0
    const float density = volume.density_inside(segment.ray.at(hit.t));
    hit.sigma_t = hit.majorant = std::max(volume.extinction * density, least);
  }
  return hit;
}

} // namespace

Collision exact_collision(const Medium& medium, const Segment& segment, Rng& rng) {
  Collision first;
  medium.for_each_met(segment, [&](std::size_t v) {
    const Collision hit = exact_collision(medium.volumes[v], segment, rng);
    if (hit.t < first.t)
      first = hit;
  });
  return first;
}

} // namespace vdbeam
