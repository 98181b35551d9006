#include "estimators/path_walk.h"

#include "transport/emission.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Weight under which Russian roulette begins.
constexpr float roulette_below = 0.1f;
/// Detours towards a narrow light, per scattering.
constexpr float detours = 0.25f;
/// A phase function that scatters this much more straight on than it does on average is worth them.
constexpr float sharp_peak = 200;

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

void WalkTracer::find_narrow_lights() {
  for (const PhaseFunction& phase : world_.medium.phases)
    peaked_.push_back(4 * pi * phase.evaluate(1) > sharp_peak);
  // Detours would count scatterings differently.
  if (max_bounces_ || std::find(peaked_.begin(), peaked_.end(), true) == peaked_.end())
    return;
  for (std::size_t i = 0; i < world_.lights.size(); ++i)
    if (shadow_rays_[i] && world_.lights[i].narrow_direction())
      narrow_lights_.push_back(i);
}

/// Density with which a detour towards this light would have drawn a direction, over that with
/// which it was drawn.
float WalkTracer::detour_density(const DrawnDirection& drawn, std::size_t light) const {
  if (std::find(narrow_lights_.begin(), narrow_lights_.end(), light) == narrow_lights_.end() ||
      !peaked_[static_cast<std::size_t>(drawn.phase - world_.medium.phases.data())])
    return 0;
  const Vec3f& towards = *world_.lights[light].narrow_direction();
  const float chance = detours / static_cast<float>(narrow_lights_.size());
  return chance * drawn.phase->evaluate(dot(towards, drawn.direction)) / drawn.pdf;
}

/// A detour, now and then: from the collision in a direction drawn about a narrow light's by the
/// phase function, to the next collision, from which a shadow ray goes to that light.
void WalkTracer::scatter_towards_light(PathWalk& walk) const {
  if (narrow_lights_.empty() ||
      !peaked_[static_cast<std::size_t>(walk.phase - world_.medium.phases.data())])
    return;
  const float u = walk.rng.uniform();
  if (u >= detours)
    return;
  const std::size_t count = narrow_lights_.size();
  const auto number = static_cast<std::size_t>(u / detours * static_cast<float>(count));
  const Light& light = world_.lights[narrow_lights_[std::min(number, count - 1)]];
  const Medium& medium = world_.medium;
  const Ray& ray = walk.segment.ray;
  const float u_lobe = walk.rng.uniform(), u1 = walk.rng.uniform(), u2 = walk.rng.uniform();
  const Vec3f& towards = *light.narrow_direction();
  const Vec3f direction = walk.phase->sample(towards, u_lobe, u1, u2);
  const float p1 = walk.phase->evaluate(dot(ray.direction, direction));
  const float drawn =
      detours / static_cast<float>(count) * walk.phase->evaluate(dot(towards, direction));

  BoundedTracker tracker(medium, {{ray.origin, direction}});
  Rgb throughput = walk.throughput;
  Collision hit;
  do {
    hit = tracker.next(walk.rng);
    if (!hit.volume)
      return;
  } while (!sample_real_collision(hit, medium.chromatic, throughput, walk.rng));
  const Vec3f point = ray.origin + direction * hit.t;
  const float v1 = walk.rng.uniform(), v2 = walk.rng.uniform();
  const IncidentSample sample = light.sample_incident(point, v1, v2);
  const PhaseFunction& phase = medium.phases[static_cast<std::size_t>(hit.volume->phase_index)];
  const float p2 = phase.evaluate(dot(direction, sample.wi));
  // Ways to the same path: this one, a walk with a shadow ray, a walk that meets the light.
  const float by_walk = sample.pdf > 0 ? p1 * (1 + p2 / sample.pdf) : p1;
  const Rgb value =
      sample.value * hit.volume->albedo_at(point) * throughput * (p1 * p2 / (by_walk + drawn));
  RatioTracking shadow(medium, {{point, sample.wi}, 0, sample.distance});
  while (shadow.advance(walk.rng))
    if (!shadow.attenuate(walk.rng))
      break;
  walk.indirect += value * shadow.transmittance();
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
  if (walk.null_collisions >= most_tentative_collisions)
    return end_flight(walk);
  return step_flight(world_.medium, walk, *this);
}

/// Ends a flight that met too many null collisions, from its present one on: by collisions that are
/// found in the exact optical depth, of which the first is real but where channels differ.
bool WalkTracer::end_flight(PathWalk& walk) const {
  const Medium& medium = world_.medium;
  Collision hit = walk.tracker->collision();
  for (;;) {
    meet(walk, hit);
    if (sample_real_collision(hit, medium.chromatic, walk.throughput, walk.rng))
      return collide(walk, hit);
    if (medium.chromatic && !walk.length.survive(walk.throughput, walk.rng))
      return false;
    const Segment rest{walk.segment.ray, hit.t, walk.segment.t_end};
    hit = exact_collision(medium, rest, walk.rng);
    if (!hit.volume)
      return leave(walk);
  }
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
  if (max_bounces_ && walk.bounces >= *max_bounces_)
    return false;
  const Vec3f point = walk.segment.ray.at(hit.t);
  walk.throughput *= hit.volume->albedo_at(point);
  if (!survive_roulette(roulette_below, walk.throughput, walk.rng) ||
      !walk.length.survive(walk.throughput, walk.rng))
    return false;
  walk.phase = &world_.medium.phases[hit.volume->phase_index];
  walk.segment.ray.origin = point;
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
    const float detour = detour_density(walk.drawn, walk.light);
    const float weight =
        sample.pdf > 0 ? sample.pdf / (sample.pdf * (1 + detour) + p) : 1 / (1 + detour);
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
  scatter_towards_light(walk);
  const Vec3f direction = walk.sample_direction(*walk.phase);
  walk.drawn_before = walk.drawn;
  walk.drawn = {direction, walk.phase, walk.phase->evaluate(dot(ray.direction, direction))};
  ++walk.bounces;
  walk.gathered = 0;
  walk.null_collisions = 0;
  walk.start(world_.medium, {{ray.origin, direction}});
  return advance_flight(walk, *this);
}

/// The flight has left the medium.
bool WalkTracer::leave(PathWalk& walk) const {
  const float t_end = walk.segment.t_end;
  if (meets_light_)
    gather_light(walk, t_end);
  else
    (walk.bounces == 1 ? walk.direct : walk.indirect) +=
        lights_met(walk, {walk.segment.ray, 0, t_end});
  return false;
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
      weight = walk.drawn.pdf / (walk.drawn.pdf + light.incident_pdf(ray.origin, ray.direction) *
                                                      (1 + detour_density(walk.drawn_before, i)));
    sum += light.emitted_radiance(segment).radiance * weight;
  }
  return sum * walk.throughput;
}

} // namespace vdbeam
