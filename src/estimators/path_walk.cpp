#include "estimators/path_walk.h"

#include "transport/emission.h"

namespace vdbeam {

namespace {

/// Weight under which Russian roulette begins.
constexpr float roulette_below = 0.1f;

} // namespace

PathWalk WalkTracer::start(std::size_t target, const Rng& rng, const Ray& ray,
                           const Rgb& throughput, const PhaseFunction& phase) const {
  PathWalk walk(rng, throughput);
  walk.segment.ray = ray;
  walk.target = target;
  walk.phase = &phase;
  // Before its first flight there is no shadow ray left to trace.
  walk.light = world_.lights.size();
  return walk;
}

bool WalkTracer::step(PathWalk& walk) const {
  if (walk.bounces == 0)
    return scatter(walk);
  if (walk.shadow) {
    if (walk.shadow->attenuate(walk.rng) && walk.shadow->advance(walk.rng))
      return true;
    walk.indirect += walk.shadow_value * walk.shadow->transmittance();
    ++walk.light;
    return sample_lights(walk);
  }
  return step_flight(world_.medium, walk, *this);
}

/// Null collisions leave a grey throughput as it is, so the light of a flight is gathered in one
/// piece up to its real collision; a coloured one changes at every collision.
void WalkTracer::meet(PathWalk& walk, const Collision& hit) const {
  if (meets_light_ && world_.medium.chromatic)
    gather_light(walk, hit.t);
}

bool WalkTracer::collide(PathWalk& walk, const Collision& hit) const {
  if (meets_light_ && !world_.medium.chromatic)
    gather_light(walk, hit.t);
  const std::optional<int>& most = world_.settings.max_bounces;
  if (most && walk.bounces >= *most)
    return false;
  walk.throughput *= hit.volume->albedo;
  if (!survive_roulette(roulette_below, walk.throughput, walk.rng) ||
      !walk.length.survive(walk.throughput, walk.rng))
    return false;
  walk.phase = &world_.medium.phases[hit.volume->phase_index];
  walk.segment.ray.origin = walk.segment.ray.at(hit.t);
  walk.light = 0;
  return sample_lights(walk);
}

/// Next-event estimation: shadow rays from the collision to the lights from walk.light on, then on
/// with the walk.
bool WalkTracer::sample_lights(PathWalk& walk) const {
  const Ray& ray = walk.segment.ray;
  for (; walk.light < world_.lights.size(); ++walk.light) {
    if (!shadow_rays_[walk.light])
      continue;
    const float u = walk.rng.uniform(), v = walk.rng.uniform();
    const IncidentSample sample = world_.lights[walk.light].sample_incident(ray.origin, u, v);
    if (max_component(sample.value) <= 0)
      continue;
    const float p = walk.phase->evaluate(dot(ray.direction, sample.wi));
    const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + p) : 1;
    walk.shadow_value = sample.value * (p * weight) * walk.throughput;
    walk.shadow.emplace(world_.medium, Segment{{ray.origin, sample.wi}, 0, sample.distance});
    if (walk.shadow->advance(walk.rng))
      return true;
    walk.indirect += walk.shadow_value;
  }
  walk.shadow.reset();
  return scatter(walk);
}

/// Draws a direction at the collision and begins the next flight.
bool WalkTracer::scatter(PathWalk& walk) const {
  const Ray& ray = walk.segment.ray;
  const Vec3f direction = walk.sample_direction(*walk.phase);
  walk.phase_pdf = walk.phase->evaluate(dot(ray.direction, direction));
  ++walk.bounces;
  walk.gathered = 0;
  walk.start(world_.medium, {{ray.origin, direction}});
  return advance_flight(walk, *this);
}

/// The flight has left the medium.
void WalkTracer::leave(PathWalk& walk) const {
  const float t_end = walk.segment.t_end;
  if (meets_light_)
    gather_light(walk, t_end);
  else
    (walk.bounces == 1 ? walk.direct : walk.indirect) +=
        lights_met(walk, {walk.segment.ray, 0, t_end});
}

/// Light that the flight meets, from where it was gathered last to t_end: the medium's own, and
/// that of the lights.
void WalkTracer::gather_light(PathWalk& walk, float t_end) const {
  Rgb& sum = walk.bounces == 1 ? walk.direct : walk.indirect;
  const Segment piece{walk.segment.ray, walk.gathered, t_end};
  if (!world_.medium.emitters.empty())
    sum += sample_emission(world_.medium, piece, walk.rng) * walk.throughput;
  if (world_.lights.any_extent() || t_end == infinity)
    sum += lights_met(walk, piece);
  walk.gathered = t_end;
}

/// The lights that the flight meets within the segment, weighted against next-event estimation.
Rgb WalkTracer::lights_met(const PathWalk& walk, const Segment& segment) const {
  const Ray& ray = segment.ray;
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
      weight = walk.phase_pdf / (walk.phase_pdf + light.incident_pdf(ray.origin, ray.direction));
    sum += light.emitted_radiance(segment).radiance * weight;
  }
  return sum * walk.throughput;
}

} // namespace vdbeam
