#include "rays/shaft_light.h"

#include "medium/distance_sampling.h"
#include "tuning/constants.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbeam {

namespace {

constexpr std::size_t points_of_ray = 2;

/// What the volumes of a point scatter from a direction into the ray, per unit of radiance.
float scattered_at(const Medium& medium, const ScatterPoint& point, float cosine) {
  float sum = 0;
  for (std::size_t i = 0; i < point.weights->size(); ++i) {
    const auto phase = static_cast<std::size_t>(medium.volumes[(*point.volumes)[i]].phase_index);
    const PhaseFunction& whole = medium.peak ? medium.peak->original[phase] : medium.phases[phase];
    const float rest = medium.peak ? 1 - medium.peak->forward[phase] : 1;
    sum += mean_component((*point.weights)[i]) * whole.evaluate(cosine) / rest;
  }
  return sum;
}

/// Light of one lamp at each point, if nothing hid it, and whether something does.
struct LightAtPoints {
  float unoccluded_light = 0; ///< mean
  std::array<bool, points_of_ray> lit{};
};

LightAtPoints light_at_points(const World& world, const Light& light, const Ray& ray,
                              DistanceSampler& distances, const std::array<float, points_of_ray>& u,
                              Rng& rng) {
  LightAtPoints found;
  for (std::size_t i = 0; i < points_of_ray; ++i) {
    const ScatterPoint point = distances.sample(u[i], 0);
    const float a = rng.uniform(), b = rng.uniform();
    const IncidentSample incident = light.sample_incident(point.position, a, b);
    const float radiance = point.pdf > 0 ? mean_component(incident.value) : 0;
    bool& lit = found.lit[i];
    lit = true; // beyond the cone of a spot, too: surfaces are what this looks for
    if (!(radiance > 0))
      continue;
    found.unoccluded_light += radiance *
                              scattered_at(world.medium, point, dot(ray.direction, incident.wi)) /
                              points_of_ray;
    lit = unoccluded(world, Vec3d(point.position), incident.wi, incident.distance);
  }
  return found;
}

} // namespace

float ShaftLight::effort(float behind) const {
  const float all = light / rays + behind;
  return all > 0 ? std::clamp(tuning::effort_in_shafts * std::sqrt(variance / rays) / all, 1.0f,
                              tuning::most_effort_in_shafts)
                 : 1;
}

ShaftLight look_for_shafts(const World& world, const Ray& ray, const DepthProfile& profile,
                           const std::vector<bool>& sampled, Rng& rng) {
  if (!world.surfaces || profile.empty())
    return {};
  DistanceSampler distances(world.medium, ray, profile);
  if (!(distances.opacity(0) > 0))
    return {};
  std::array<float, points_of_ray> u;
  for (float& place : u)
    place = rng.uniform();
  std::array<float, points_of_ray> light{};
  for (std::size_t l = 0; l < world.lights.size(); ++l)
    if (sampled[l]) {
      const LightAtPoints found = light_at_points(world, world.lights[l], ray, distances, u, rng);
      for (std::size_t i = 0; i < points_of_ray; ++i)
        light[i] += found.lit[i] ? found.unoccluded_light : 0;
    }
  const float difference = light[0] - light[1];
  return {1, 0.5f * (light[0] + light[1]), 0.5f * difference * difference};
}

} // namespace vdbeam
