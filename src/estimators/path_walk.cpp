#include "estimators/path_walk.h"

#include "transport/emission.h"

namespace vdbeam {

namespace {

/// Weight under which Russian roulette begins.
constexpr float roulette_below = 0.1f;

} // namespace

PathWalk WalkTracer::start(std::size_t target, const Rng& rng, const Ray& ray,
                           const Rgb& throughput, const PhaseFunction& phase) const {
  // At its first step there is no shadow ray left to trace.
  return {target, rng, ray,          throughput,           0, 0, std::nullopt, 0, {}, &phase,
          {},     {},  std::nullopt, world_.lights.size(), {}};
}

bool WalkTracer::step(PathWalk& walk) const {
  if (walk.bounces == 0)
    return shine(walk);
  if (walk.shadow) {
    if (walk.shadow->attenuate(walk.rng) && walk.shadow->advance(walk.rng))
      return true;
    walk.indirect += walk.shadow_value * walk.shadow->transmittance();
    ++walk.light;
    return shine(walk);
  }
  const Collision hit = walk.flight->collision();
  // Null collisions leave a grey throughput as it is, so one piece of the flight goes up to the
  // next real one.
  const bool chromatic = world_.medium.chromatic;
  if (glows_ && chromatic)
    gather_emission(walk, hit.t);
  if (!collide_really(hit, chromatic, walk.throughput, walk.rng))
    return fly(walk);
  if (glows_ && !chromatic)
    gather_emission(walk, hit.t);
  const std::optional<int>& most = world_.settings.max_bounces;
  if (most && walk.bounces >= *most)
    return false;
  walk.throughput *= hit.volume->albedo;
  if (!survive_roulette(roulette_below, walk.throughput, walk.rng) ||
      !walk.length.survive(walk.throughput, walk.rng))
    return false;
  walk.phase = &world_.medium.phases[hit.volume->group];
  walk.ray.origin = walk.ray.at(hit.t);
  walk.light = 0;
  return shine(walk);
}

/// Shadow rays from the collision to the lights from walk.light on, then on with the walk.
bool WalkTracer::shine(PathWalk& walk) const {
  for (; walk.light < world_.lights.size(); ++walk.light) {
    if (!shadow_rays_[walk.light])
      continue;
    const float u = walk.rng.uniform(), v = walk.rng.uniform();
    const IncidentSample sample = world_.lights[walk.light].sample_incident(walk.ray.origin, u, v);
    if (max_component(sample.value) <= 0)
      continue;
    const float p = walk.phase->evaluate(dot(walk.ray.direction, sample.wi));
    const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + p) : 1;
    walk.shadow_value = sample.value * (p * weight) * walk.throughput;
    walk.shadow.emplace(world_.medium, Ray{walk.ray.origin, sample.wi}, sample.distance);
    if (walk.shadow->advance(walk.rng))
      return true;
    walk.indirect += walk.shadow_value;
  }
  walk.shadow.reset();
  turn(walk);
  return fly(walk);
}

void WalkTracer::turn(PathWalk& walk) const {
  const float u_lobe = walk.rng.uniform(), u = walk.rng.uniform(), v = walk.rng.uniform();
  const Vec3f direction = walk.phase->sample(walk.ray.direction, u_lobe, u, v);
  walk.phase_pdf = walk.phase->evaluate(dot(walk.ray.direction, direction));
  walk.ray.direction = direction;
  ++walk.bounces;
  walk.gathered = 0;
  walk.flight.emplace(world_.medium, walk.ray, 0.0f, infinity);
}

/// To the flight's next tentative collision, or out of the medium.
bool WalkTracer::fly(PathWalk& walk) const {
  if (walk.flight->advance(walk.rng))
    return true;
  if (glows_)
    gather_emission(walk, infinity);
  (walk.bounces == 1 ? walk.direct : walk.indirect) += escape(walk);
  return false;
}

/// The medium's own light on the flight, from where it was gathered last to t_end.
void WalkTracer::gather_emission(PathWalk& walk, float t_end) const {
  const Rgb light = sample_emission(world_.medium, walk.ray, walk.gathered, t_end, walk.rng);
  (walk.bounces == 1 ? walk.direct : walk.indirect) += light * walk.throughput;
  walk.gathered = t_end;
}

/// Light that a ray meets where it leaves the scene, weighted against next-event estimation.
Rgb WalkTracer::escape(const PathWalk& walk) const {
  Rgb sum;
  for (std::size_t i = 0; i < world_.lights.size(); ++i) {
    const Light& light = world_.lights[i];
    if (light.is_delta())
      continue;
    // Single scattering of these is complete already (direct_light draws both strategies).
    if (walk.bounces == 1 && shadow_rays_[i])
      continue;
    float weight = 1;
    if (shadow_rays_[i])
      weight = walk.phase_pdf /
               (walk.phase_pdf + light.incident_pdf(walk.ray.origin, walk.ray.direction));
    sum += light.escaped_radiance(walk.ray.direction) * weight;
  }
  return sum * walk.throughput;
}

} // namespace vdbeam
