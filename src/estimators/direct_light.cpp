#include "estimators/direct_light.h"

#include "transport/distance_sampling.h"

namespace vdbeam {

namespace {

/// Radiance that one light scatters at a point into the ray, per unit of weight.
Rgb scattered_light(const World& world, const Light& light, const PhaseFunction& phase,
                    const Vec3f& point, const Vec3f& direction, Rng& rng) {
  Rgb sum;
  const float u = rng.uniform(), v = rng.uniform();
  const IncidentSample sample = light.sample_incident(point, u, v);
  if (max_component(sample.value) > 0) {
    const float p = phase.evaluate(dot(direction, sample.wi));
    const float mis = sample.pdf > 0 ? sample.pdf / (sample.pdf + p) : 1;
    if (p * mis > 0)
      sum += sample.value * (p * mis) *
             exact_transmittance(world.medium, {point, sample.wi}, sample.distance);
  }
  if (light.is_delta())
    return sum;
  const float u_lobe = rng.uniform(), u2 = rng.uniform(), v2 = rng.uniform();
  const Vec3f wi = phase.sample(direction, u_lobe, u2, v2);
  const Rgb radiance = light.escaped_radiance(wi);
  if (max_component(radiance) > 0) {
    const float p = phase.evaluate(dot(direction, wi));
    const float mis = p / (p + light.incident_pdf(point, wi));
    sum += radiance * mis * exact_transmittance(world.medium, {point, wi}, infinity);
  }
  return sum;
}

} // namespace

Rgb direct_light(const World& world, const Ray& ray, const DepthProfile& profile,
                 const std::vector<bool>& sampled, int samples, Rng& rng) {
  Rgb sum;
  if (profile.empty() || std::find(sampled.begin(), sampled.end(), true) == sampled.end())
    return sum;
  const Medium& medium = world.medium;
  DistanceSampler distances(medium, ray, profile);
  for (int i = 0; i < samples; ++i) {
    const float u = (static_cast<float>(i) + rng.uniform()) / static_cast<float>(samples);
    const int c = medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
    if (!(distances.opacity(c) > 0))
      continue;
    const ScatterPoint point = distances.sample(u, c);
    for (std::size_t v = 0; v < medium.volumes.size(); ++v) {
      const Rgb& weight = (*point.weights)[v];
      if (!(max_component(weight) > 0))
        continue;
      for (std::size_t l = 0; l < world.lights.size(); ++l)
        if (sampled[l])
          sum += weight * scattered_light(world, world.lights[l],
                                          medium.phases[medium.volumes[v].group], point.position,
                                          ray.direction, rng);
    }
  }
  return sum / static_cast<float>(samples);
}

} // namespace vdbeam
