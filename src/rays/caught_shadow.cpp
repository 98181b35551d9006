#include "rays/caught_shadow.h"

#include "medium/optical_depth.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Shadow rays to a light that has an extent, and samples by which it is weighed.
constexpr int rays_per_light = 16, samples_per_light = 64;

/// Transmittance of the medium and of all surfaces but catchers.
Rgb unobstructed(const World& world, Vec3d origin, const IncidentSample& sample) {
  const Surfaces& surfaces = *world.surfaces;
  const Vec3f from(origin);
  // What lies within 1e-4 of the distance before its end is the light itself.
  double left = static_cast<double>(sample.distance) * (1 - 1e-4);
  for (;;) {
    const auto hit = surfaces.set->intersect(origin, Vec3d(sample.wi), 0, left);
    if (!hit)
      return exact_transmittance(world.medium, {{from, sample.wi}, 0, sample.distance});
    if (!surfaces.material(*hit).is_shadow_catcher())
      return {};
    origin = hit->leave(sample.wi);
    left -= hit->t;
  }
}

/// The light of one light on a surface, without and with what stands in its way.
struct Irradiance {
  Rgb whole, arriving;
};

/// Calls visit(sample, cosine) for samples of a light, which fill a shifted lattice.
template <class Visit>
void for_each_sample(const Light& light, const Vec3f& point, const Vec3f& normal, int count,
                     Rng& rng, const Visit& visit) {
  constexpr float golden = 0.6180340f;
  const float u = rng.uniform(), v = rng.uniform();
  for (int s = 0; s < count; ++s) {
    const float turned = v + golden * static_cast<float>(s);
    const IncidentSample sample =
        light.sample_incident(point, (static_cast<float>(s) + u) / static_cast<float>(count),
                              std::min(turned - std::floor(turned), 0x1.fffffep-1f));
    const float cosine = dot(sample.wi, normal) / static_cast<float>(count);
    if (cosine > 0 && max_component(sample.value) > 0)
      visit(sample, cosine);
  }
}

Irradiance irradiance_of(const World& world, const Light& light, const SurfaceHit& hit,
                         const Vec3f& normal, Rng& rng) {
  Irradiance sum;
  const Vec3f point(hit.position);
  for_each_sample(light, point, normal, light.is_delta() ? 1 : rays_per_light, rng,
                  [&](const IncidentSample& sample, float cosine) {
                    const Rgb light_there = sample.value * cosine;
                    sum.whole += light_there;
                    sum.arriving += light_there * unobstructed(world, hit.leave(sample.wi), sample);
                  });
  if (light.is_delta())
    return sum;
  Rgb whole;
  for_each_sample(
      light, point, normal, samples_per_light, rng,
      [&](const IncidentSample& sample, float cosine) { whole += sample.value * cosine; });
  for (int c = 0; c < 3; ++c)
    sum.arriving[c] = sum.whole[c] > 0 ? whole[c] * (sum.arriving[c] / sum.whole[c]) : whole[c];
  sum.whole = whole;
  return sum;
}

} // namespace

CaughtShadow caught_shadow(const World& world, const CameraRay& camera, Rng& rng) {
  const SurfaceHit& hit = *camera.hit;
  const Vec3f& direction = camera.ray().direction;
  const Vec3f normal = hit.normal * std::copysign(1.0f, -dot(hit.normal, direction));
  Irradiance all;
  for (std::size_t i = 0; i < world.lights.size(); ++i) {
    if (!world.lights.in_plate(i))
      continue;
    const Irradiance light = irradiance_of(world, world.lights[i], hit, normal, rng);
    all.whole += light.whole;
    all.arriving += light.arriving;
  }
  CaughtShadow caught;
  const float whole = mean_component(all.whole);
  if (whole > 0)
    caught.mean = std::clamp(1 - mean_component(all.arriving) / whole, 0.0f, 1.0f);
  for (int c = 0; c < 3; ++c)
    if (all.whole[c] > 0)
      caught.left[c] = std::clamp(all.arriving[c] / all.whole[c], 0.0f, 1.0f);
  return caught;
}

} // namespace vdbeam
