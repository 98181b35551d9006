#include "estimators/path/path_walk.h"

#include "medium/emission.h"

namespace vdbeam {

namespace {

/// The same of walks that branch, in parts of the weight with which they began. They become many
/// where they matter; with 0.1 they would be many elsewhere too.
constexpr float roulette_of_branches_below = 0.6f;

} // namespace

PathWalk WalkTracer::start(std::size_t target, const Rng& rng, const Ray& ray,
                           const Rgb& throughput, const PhaseFunction& phase) const {
  PathWalk walk(rng, throughput);
  walk.segment.ray = ray;
  walk.least_weight = light_branches_.any() ? roulette_of_branches_below * max_component(throughput)
                                            : roulette_below;
  walk.target = target;
  walk.phase = &phase;
  // Before its first flight there is no shadow ray left to trace.
  walk.light = world_.lights.size();
  return walk;
}

/// Density of flights from the walk's collision in this direction, its branches among them.
float WalkTracer::flight_density(const PathWalk& walk, const Vec3f& direction) const {
  return walk.phase->evaluate(dot(walk.segment.ray.direction, direction)) +
         light_branches_.density(*walk.phase, direction);
}

bool WalkTracer::step(PathWalk& walk, std::vector<PathWalk>& branches) const {
  if (walk.scatters) {
    branch(walk, branches);
    return begin_flight(walk, walk.sample_direction(*walk.phase));
  }
  if (walk.shadow) {
    if (walk.shadow->attenuate(walk.rng) && walk.shadow->advance(walk.rng))
      return true;
    walk.indirect += walk.shadow_value * walk.shadow->transmittance();
    ++walk.light;
    sample_lights(walk);
    return true;
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
  if (!outlives_roulette(walk) || !walk.length.survive(walk.throughput, walk.rng))
    return false;
  walk.phase = &world_.medium.phases[hit.volume->phase_index];
  walk.segment.ray.origin = point;
  walk.light = 0;
  sample_lights(walk);
  return true;
}

/// Next-event estimation: shadow rays from the collision to the lights from walk.light on, one at a
/// time; then the walk scatters.
void WalkTracer::sample_lights(PathWalk& walk) const {
  const Ray& ray = walk.segment.ray;
  for (; walk.light < world_.lights.size(); ++walk.light) {
    if (!shadow_rays_[walk.light])
      continue;
    const float u = walk.rng.uniform(), v = walk.rng.uniform();
    const IncidentSample sample = world_.lights[walk.light].sample_incident(ray.origin, u, v);
    if (max_component(sample.value) <= 0)
      continue;
    const float p = walk.phase->evaluate(dot(ray.direction, sample.wi));
    const float weight =
        sample.pdf > 0 ? sample.pdf / (sample.pdf + flight_density(walk, sample.wi)) : 1;
    walk.shadow_value = sample.value * (p * weight) * walk.throughput;
    walk.shadow.emplace(world_.medium, Segment{{ray.origin, sample.wi}, 0, sample.distance});
    if (walk.shadow->advance(walk.rng))
      return;
    walk.indirect += walk.shadow_value;
  }
  walk.shadow.reset();
  walk.scatters = true;
}

/// Now and then, a walk of its own from the collision, about the direction of a narrow light.
void WalkTracer::branch(PathWalk& walk, std::vector<PathWalk>& branches) const {
  const std::optional<Vec3f> direction = light_branches_.sample(*walk.phase, walk.rng);
  if (!direction)
    return;
  PathWalk branch = walk;
  branch.direct = branch.indirect = Rgb();
  const std::uint64_t high = walk.rng.bits(), low = walk.rng.bits();
  branch.rng = Rng({}, RngStage::split, high << 32 | low);
  if (begin_flight(branch, *direction)) {
    branches.push_back(branch);
    return;
  }
  walk.direct += branch.direct;
  walk.indirect += branch.indirect;
}

/// Begins a flight from the walk's collision, one of those of the walk and its branches.
bool WalkTracer::begin_flight(PathWalk& walk, const Vec3f& direction) const {
  const Ray from = walk.segment.ray;
  walk.density = flight_density(walk, direction);
  ++walk.bounces;
  walk.scatters = false;
  walk.gathered = 0;
  walk.null_collisions = 0;
  walk.start(world_.medium, {{from.origin, direction}});
  if (light_branches_.any()) {
    walk.throughput *= walk.phase->evaluate(dot(from.direction, direction)) / walk.density;
    if (!outlives_roulette(walk))
      return false;
  }
  return advance_flight(walk, *this);
}

/// Russian roulette on what the walk's flight is about to bring.
bool WalkTracer::outlives_roulette(PathWalk& walk) const {
  const float importance = light_branches_.importance(walk.segment.ray.direction);
  return survive_roulette(walk.least_weight / importance, walk.throughput, walk.rng);
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
      weight = walk.density / (walk.density + light.incident_pdf(ray.origin, ray.direction));
    sum += light.emitted_radiance(segment).radiance * weight;
  }
  return sum * walk.throughput;
}

} // namespace vdbeam
