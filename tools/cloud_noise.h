#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>

namespace vdbeam {

/// Gradient noise (Perlin 2002), about -1 to 1, with features of one unit.
float gradient_noise(const openvdb::Vec3f& p, std::uint32_t seed);

/// Sum of octaves of gradient noise, each of half the size and half the strength of the previous
/// one; about -1 to 1.
float fractal_noise(openvdb::Vec3f p, int octaves, std::uint32_t seed);

/// Rounded bumps with sharp creases between them, 0 to 1 and about 0.6 in the mean: cellular noise
/// (Worley 1996) turned over. There is about one bump per unit cube.
float billow_noise(const openvdb::Vec3f& p, std::uint32_t seed);

/// Repeatable numbers in [0, 1), the same on every machine (SplitMix64).
class Dice {
public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  float next();
  float between(float lower, float upper) { return lower + (upper - lower) * next(); }

private:
  std::uint64_t state_;
};

/// Rises smoothly from 0 at `lower` to 1 at `upper`.
inline float smooth_step(float lower, float upper, float x) {
  const float t = (x - lower) / (upper - lower);
  return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}

} // namespace vdbeam
