#include "cloud_noise.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

using openvdb::Vec3f;

std::uint32_t mix(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9e3779b9u;
  for (const int c : {x, y, z}) {
    h ^= static_cast<std::uint32_t>(c);
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
  }
  return h;
}

/// Dot product with one of the twelve directions to the edges of a cube.
float along_edge(std::uint32_t h, float x, float y, float z) {
  const std::uint32_t edge = h & 15u;
  const float u = edge < 8 ? x : y;
  const float v = edge < 4 ? y : edge == 12 || edge == 14 ? x : z;
  return ((edge & 1u) ? -u : u) + ((edge & 2u) ? -v : v);
}

float fade(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

float blend(float a, float b, float t) {
  return a + (b - a) * t;
}

} // namespace

float gradient_noise(const Vec3f& p, std::uint32_t seed) {
  int cell[3];
  float t[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float floor = std::floor(p[axis]);
    cell[axis] = static_cast<int>(floor);
    t[axis] = p[axis] - floor;
  }
  float corner[8];
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = (i >> 1) & 1, z = i >> 2;
    corner[i] =
        along_edge(mix(cell[0] + x, cell[1] + y, cell[2] + z, seed), t[0] - static_cast<float>(x),
                   t[1] - static_cast<float>(y), t[2] - static_cast<float>(z));
  }
  const float u = fade(t[0]), v = fade(t[1]), w = fade(t[2]);
  const float front = blend(blend(corner[0], corner[1], u), blend(corner[2], corner[3], u), v);
  const float back = blend(blend(corner[4], corner[5], u), blend(corner[6], corner[7], u), v);
  return blend(front, back, w);
}

float fractal_noise(Vec3f p, int octaves, std::uint32_t seed) {
  float sum = 0, strength = 0.6f;
  for (int i = 0; i < octaves; ++i) {
    sum += strength * gradient_noise(p, seed + static_cast<std::uint32_t>(i) * 17);
    p = p * 2.03f + Vec3f(3.1f, 1.7f, 5.3f);
    strength *= 0.5f;
  }
  return sum;
}

float billow_noise(const Vec3f& p, std::uint32_t seed) {
  constexpr float inset = 0.1f; // centres keep away from the faces of their cells
  int cell[3];
  float t[3];
  float gap[3][3]; // least squared distance along each axis to centres in cells -1, 0 and 1
  for (int axis = 0; axis < 3; ++axis) {
    const float floor = std::floor(p[axis]);
    cell[axis] = static_cast<int>(floor);
    t[axis] = p[axis] - floor;
    const float below = t[axis] + inset, above = 1 - t[axis] + inset;
    gap[axis][0] = below * below;
    gap[axis][1] = 0;
    gap[axis][2] = above * above;
  }
  // The cell of the point first: most of the others are then too far away.
  static constexpr int order[3] = {1, 0, 2};
  float nearest = 4;
  for (int i = 0; i < 27; ++i) {
    const int x = order[i % 3], y = order[i / 3 % 3], z = order[i / 9];
    if (gap[0][x] + gap[1][y] + gap[2][z] >= nearest)
      continue;
    const std::uint32_t h = mix(cell[0] + x - 1, cell[1] + y - 1, cell[2] + z - 1, seed);
    const auto jitter = [h](int shift) {
      return inset + (1 - 2 * inset) * static_cast<float>((h >> shift) & 1023u) / 1023.0f;
    };
    const Vec3f to_centre(static_cast<float>(x - 1) + jitter(0) - t[0],
                          static_cast<float>(y - 1) + jitter(10) - t[1],
                          static_cast<float>(z - 1) + jitter(20) - t[2]);
    nearest = std::min(nearest, to_centre.lengthSqr());
  }
  return std::max(1 - nearest, 0.0f);
}

float Dice::next() {
  state_ += 0x9e3779b97f4a7c15;
  std::uint64_t h = state_;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
  h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
  h ^= h >> 31;
  return static_cast<float>(h >> 40) * 0x1p-24f;
}

} // namespace vdbeam
