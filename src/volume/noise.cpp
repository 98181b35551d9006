#include "volume/noise.h"

#include "math/rng.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// Greatest value of the noise before it is scaled: a blend of the corners of a cube by the fade
/// curves, where each corner gives the sum of two coordinates at most, stays below this.
constexpr double largest_sum = 1.05;

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

/// Product of an offset with the gradient of a lattice point: one of the 12 edges of a cube.
double corner(std::uint64_t seed, const Vec3<std::int64_t>& point, const Vec3d& offset) {
  std::uint64_t hash = mix64(seed);
  for (int a = 0; a < 3; ++a)
    hash = mix64(hash ^ static_cast<std::uint64_t>(point[a]));
  const auto edge = static_cast<int>((hash >> 32) % 12);
  const int axis = edge / 4; // the edge is perpendicular to it
  const double u = offset[(axis + 1) % 3], v = offset[(axis + 2) % 3];
  return (edge & 1 ? -u : u) + (edge & 2 ? -v : v);
}

} // namespace

double gradient_noise(const Vec3d& point, std::uint64_t seed) {
  const Vec3d below{std::floor(point.x), std::floor(point.y), std::floor(point.z)};
  const Vec3d offset = point - below;
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3<std::int64_t> step{i & 1, i >> 1 & 1, i >> 2};
    double weight = 1;
    for (int a = 0; a < 3; ++a)
      weight *= step[a] ? fade(offset[a]) : 1 - fade(offset[a]);
    sum += weight * corner(seed, Vec3<std::int64_t>(below) + step, offset - Vec3d(step));
  }
  return std::clamp(sum / largest_sum, -1.0, 1.0);
}

Vec3d noise_displacement(const NoiseSettings& settings, const Vec3d& point) {
  Vec3d sum;
  double total = 0, strength = 1, frequency = 1 / settings.size;
  for (int octave = 0; octave < settings.octaves; ++octave) {
    for (int a = 0; a < 3; ++a)
      sum[a] +=
          strength * gradient_noise(point * frequency,
                                    settings.seed + (static_cast<std::uint64_t>(octave) << 40) +
                                        (static_cast<std::uint64_t>(a) << 48));
    total += strength;
    strength /= 2;
    frequency *= 2;
  }
  return sum * (settings.amplitude / total);
}

} // namespace vdbeam
