#include "rays/caught_shadow.h"

#include "medium/optical_depth.h"

namespace vdbeam {

namespace {

/// Shadow rays to a light that has an extent.
constexpr int samples_per_light = 16;

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

} // namespace

float caught_shadow(const World& world, const CameraRay& camera, Rng& rng) {
  const LightSet& lights = world.lights;
  const SurfaceHit& hit = *camera.hit;
  const Vec3f& direction = camera.ray().direction;
  const Vec3f normal = hit.normal * std::copysign(1.0f, -dot(hit.normal, direction));
  Rgb lit, expected;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const int samples = light.is_delta() ? 1 : samples_per_light;
    for (int s = 0; s < samples; ++s) {
      const float u = (static_cast<float>(s) + rng.uniform()) / static_cast<float>(samples);
      const float v = rng.uniform();
      const IncidentSample sample = light.sample_incident(Vec3f(hit.position), u, v);
      const float cosine = dot(sample.wi, normal) / static_cast<float>(samples);
      if (!(cosine > 0) || max_component(sample.value) <= 0)
        continue;
      expected += sample.value * cosine;
      lit += sample.value * unobstructed(world, hit.leave(sample.wi), sample) * cosine;
    }
  }
  const float whole = mean_component(expected);
  return whole > 0 ? std::clamp(1 - mean_component(lit) / whole, 0.0f, 1.0f) : 0;
}

} // namespace vdbeam
