#pragma once

#include "lights/light_table.h"
#include "math/rng.h"
#include "math/sampling.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam::test {

inline Parallelepiped make_box(const Vec3f& corner, const Vec3f& a, const Vec3f& b,
                               const Vec3f& c) {
  return {corner, {a, b, c}};
}

inline Parallelepiped cube(const Vec3f& center, float size) {
  return make_box(center - Vec3f(size / 2), {size, 0, 0}, {0, size, 0}, {0, 0, size});
}

/// A sheared, rotated box with a negative determinant.
inline Parallelepiped skew_box() {
  return make_box({0.1f, -0.3f, -0.2f}, {0.5f, 0.3f, 0.1f}, {-0.3f, 0.6f, 0.05f},
                  {0.1f, -0.1f, -0.4f});
}

inline OccupiedRegion region_of(const std::vector<Parallelepiped>& boxes) {
  OccupiedRegion region;
  region.boxes = boxes;
  Boxf bounds;
  for (const Parallelepiped& box : boxes)
    for (int corner = 0; corner < 8; ++corner) {
      Vec3f p = box.corner;
      for (int i = 0; i < 3; ++i)
        if (corner >> i & 1)
          p += box.edges[i];
      bounds.extend(p);
    }
  region.center = bounds.center();
  region.radius = length(bounds.size()) / 2;
  return region;
}

/// A light and the region it was made for, in a render space of scale 1 unless given otherwise.
struct MadeLight {
  OccupiedRegion region;
  RenderSpace space;
  std::unique_ptr<Light> light;

  MadeLight(const LightSettings& settings, OccupiedRegion region_, double scale = 1)
      : region(std::move(region_)), space{{}, scale},
        light(light_kind(settings.type).make(settings, LightContext{{0, 1, 0}, space, region})) {}
};

/// What a ray in this direction sees of a light beyond the scene.
inline Rgb escaped_radiance(const Light& light, const Vec3f& direction) {
  const LightHit hit = light.emitted_radiance({{{}, direction}});
  EXPECT_EQ(hit.distance, infinity);
  return hit.radiance;
}

/// Length of the part of a ray inside a parallelepiped, from its origin on.
inline double chord(const Parallelepiped& box, const Ray& ray) {
  const Vec3d a(box.edges[0]), b(box.edges[1]), c(box.edges[2]);
  const double volume = dot(a, cross(b, c));
  const Vec3d p = Vec3d(ray.origin) - Vec3d(box.corner), d(ray.direction);
  double enter = 0, leave = 1e30;
  for (const Vec3d& dual : {cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume}) {
    const double x = dot(dual, p), slope = dot(dual, d);
    const double t0 = -x / slope, t1 = (1 - x) / slope;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return std::max(0.0, leave - enter);
}

inline double volume_of(const Parallelepiped& box) {
  return std::abs(static_cast<double>(dot(box.edges[0], cross(box.edges[1], box.edges[2]))));
}

inline bool contains(const Parallelepiped& box, const Vec3d& p) {
  const Vec3d a(box.edges[0]), b(box.edges[1]), c(box.edges[2]);
  const double volume = dot(a, cross(b, c));
  const Vec3d q = p - Vec3d(box.corner);
  for (const Vec3d& dual : {cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume})
    if (dot(dual, q) < 0 || dot(dual, q) > 1)
      return false;
  return true;
}

/// Mean and standard error of a sequence.
struct Average {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double error() const {
    return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / (count - 1));
  }
};

/// Flux of photons that reach any box, and fluence in the union of boxes (vacuum): flux times the
/// length of the path in the union, here by marching points along the ray for overlapping boxes.
struct Emission {
  Average flux;    ///< of photons that meet a box
  Average fluence; ///< flux * chord of the first box / volume
  int outside = 0; ///< photons that start inside a box by more than rounding
};

inline Emission emit_many(const MadeLight& made, int count, const Parallelepiped& probe,
                          std::uint64_t stream = 0) {
  Emission result;
  for (int i = 0; i < count; ++i) {
    Rng rng({}, RngStage::test, stream * 1000003 + static_cast<std::uint64_t>(i));
    const EmittedPhoton photon = made.light->emit(rng);
    bool meets = false;
    for (const Parallelepiped& box : made.region.boxes)
      meets = meets || chord(box, photon.ray) > 0;
    result.flux.add(meets ? static_cast<double>(photon.flux.x) : 0);
    result.fluence.add(static_cast<double>(photon.flux.x) * chord(probe, photon.ray) /
                       volume_of(probe));
    for (const Parallelepiped& box : made.region.boxes)
      if (contains(box, Vec3d(photon.ray.at(1e-4f))) && contains(box, Vec3d(photon.ray.at(-1e-4f))))
        ++result.outside;
  }
  return result;
}

/// Within `sigmas` standard errors, and a rounding allowance relative to the value.
inline void expect_mean(const Average& average, double expected, double sigmas = 4.5) {
  EXPECT_NEAR(average.mean(), expected, sigmas * average.error() + 2e-5 * std::abs(expected))
      << "standard error " << average.error();
  EXPECT_LT(average.error(), 0.05 * std::abs(expected)) << "too few samples";
}

} // namespace vdbeam::test
