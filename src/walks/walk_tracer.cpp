#include "walks/walk_tracer.h"

#include "transport/next_event.h"
#include "tuning/constants.h"

namespace vdbeam {

float WalkTracer::roulette_from(const Rgb& throughput) const {
  return light_branches_.any_in_peaks()
             ? tuning::roulette_of_branches_below * max_component(throughput)
             : tuning::roulette_below;
}

PathWalk WalkTracer::start(std::size_t target, const Rng& rng, const Ray& ray,
                           const Rgb& throughput, const PhaseFunction& phase) const {
  PathWalk walk(rng, throughput);
  walk.segment.ray = ray;
  walk.least_weight = roulette_from(throughput);
  walk.target = target;
  walk.phase = &phase;
  walk.vertex = light_branches_.at(ray.origin);
  walk.scatters = true;
  walk.skips_sampled = true; // direct_light draws both strategies
  return walk;
}

/// Density of flights from the walk's collision in this direction, its branches among them.
float WalkTracer::flight_density(const PathWalk& walk, const Vec3f& direction) const {
  return walk.phase->evaluate(dot(walk.segment.ray.direction, direction)) +
         walk.vertex.density(*walk.phase, direction);
}

bool WalkTracer::step(PathWalk& walk, std::vector<PathWalk>& branches) const {
  if (walk.scatters) {
    branch(walk, branches);
    return scatter(walk, walk.sample_direction(*walk.phase));
  }
  if (walk.shadow) {
    if (walk.shadow->attenuate(walk.rng) && walk.shadow->advance(walk.rng))
      return true;
    walk.indirect.add(walk.shadow_value * walk.shadow->transmittance(),
                      world_.lights.group(walk.lights[walk.light].light));
    ++walk.light;
    sample_lights(walk);
    return true;
  }
  return step_flight(world_.medium, walk, *this);
}

/// Null collisions leave a grey throughput as it is, so the light of a flight is gathered in one
/// piece up to its real collision; a coloured one changes at every collision.
void WalkTracer::meet(PathWalk& walk, const Collision& hit) const {
  if (meets_light_ && world_.medium.chromatic)
    gather_light(walk, hit.t, hit.t);
}

bool WalkTracer::collide(PathWalk& walk, const Collision& hit) const {
  if (meets_light_ && !world_.medium.chromatic)
    gather_light(walk, hit.t, hit.t);
  if (max_bounces_ && walk.bounces >= *max_bounces_)
    return false;
  Ray& ray = walk.segment.ray;
  ray.origin = ray.at(hit.t);
  light_branches_.move(walk.vertex, ray.origin);
  walk.throughput *= hit.volume->albedo_at(ray.origin);
  if (!outlives_roulette(walk) || !walk.length.survive(walk.throughput, walk.rng))
    return false;
  walk.phase = &world_.medium.phases[hit.volume->phase_index];
  walk.skips_sampled = walk.from_surface = walk.in_plate = false;
  walk.from_medium = true;
  walk.light = 0;
  light_draw_.draw(
      MediumVertex{ray.origin, ray.direction, *walk.phase}, walk.rng,
      [&](std::size_t light) {
        return shells_.holds(light, ray.origin) ||
               (!walk.all_light && world_.lights[light].is_near());
      },
      walk.lights);
  walk.shadow_rays += walk.lights.size();
  sample_lights(walk);
  return true;
}

/// Next-event estimation: shadow rays from the collision to the lights from walk.light on, one at a
/// time; then the walk scatters.
void WalkTracer::sample_lights(PathWalk& walk) const {
  const Ray& ray = walk.segment.ray;
  for (; walk.light < walk.lights.size(); ++walk.light) {
    const auto [light, weight] = walk.lights[walk.light];
    const auto direct = sample_direct_light(
        world_, world_.lights[light], MediumVertex{ray.origin, ray.direction, *walk.phase},
        walk.rng, [&](const Vec3f& wi) { return flight_density(walk, wi); });
    if (!direct)
      continue;
    walk.shadow_value = direct->radiance() * walk.throughput * weight;
    walk.shadow.emplace(world_.medium, direct->segment);
    if (walk.shadow->advance(walk.rng))
      return;
    walk.indirect.add(walk.shadow_value, world_.lights.group(light));
  }
  walk.shadow.reset();
  walk.scatters = true;
}

/// Now and then, a walk of its own from the collision, about the direction of a narrow light.
void WalkTracer::branch(PathWalk& walk, std::vector<PathWalk>& branches) const {
  const std::optional<Vec3f> direction = walk.vertex.sample(*walk.phase, walk.rng);
  if (!direction)
    return;
  PathWalk branch = walk;
  branch.direct = branch.indirect = {};
  branch.shadow_rays = 0;
  const std::uint64_t high = walk.rng.bits(), low = walk.rng.bits();
  branch.rng = Rng({}, RngStage::split, high << 32 | low);
  if (scatter(branch, *direction)) {
    branches.push_back(branch);
    return;
  }
  walk.direct += branch.direct;
  walk.indirect += branch.indirect;
  walk.shadow_rays += branch.shadow_rays;
}

/// Begins a flight, which ends at the first surface.
void WalkTracer::set_out(PathWalk& walk, const Vec3d& origin, const Vec3f& direction) const {
  walk.scatters = false;
  walk.CameraWalk::set_out(world_, origin, direction);
}

/// Begins a flight from the walk's collision, one of those of the walk and its branches.
bool WalkTracer::scatter(PathWalk& walk, const Vec3f& direction) const {
  const Ray from = walk.segment.ray;
  walk.density = flight_density(walk, direction);
  ++walk.bounces;
  set_out(walk, Vec3d(from.origin), direction);
  if (light_branches_.any()) {
    walk.throughput *= walk.phase->evaluate(dot(from.direction, direction)) / walk.density;
    if (!outlives_roulette(walk))
      return false;
  }
  look_into_shells(walk);
  return advance_flight(walk, *this);
}

/// Adds the light of lamps that the flight passes, which collisions there leave out.
void WalkTracer::look_into_shells(PathWalk& walk) const {
  if (!shells_.any() || !walk.all_light || (max_bounces_ && walk.bounces >= *max_bounces_))
    return;
  walk.indirect += shells_.along(walk.segment, walk.rng, walk.shadow_rays) * walk.throughput;
}

/// Russian roulette on what the walk's flight is about to bring.
bool WalkTracer::outlives_roulette(PathWalk& walk) const {
  const float importance = walk.vertex.importance(walk.segment.ray.direction);
  return survive_roulette(walk.least_weight * walk.refraction / importance, walk.throughput,
                          walk.rng);
}

/// The flight has left the medium; it may end at a surface.
bool WalkTracer::leave(PathWalk& walk) const {
  gather_light(walk, walk.segment.t_end, walk.end ? static_cast<float>(walk.end->t) : infinity);
  return walk.end && meet_surface(walk);
}

void WalkTracer::gather_light(PathWalk& walk, float medium_end, float t_end) const {
  walk.add(meet_light(world_, walk, medium_end, t_end,
                      [&](std::size_t light) { return weight_of_met(walk, light); }));
}

/// Weight of a light that the flight meets against next-event estimation.
float WalkTracer::weight_of_met(const PathWalk& walk, std::size_t i) const {
  const Light& light = world_.lights[i];
  if (walk.in_plate || (shadow_rays_[i] && walk.leaves_out(light)))
    return 0;
  if (!shadow_rays_[i] || !(walk.density > 0))
    return 1;
  const Ray& ray = walk.segment.ray;
  return walk.density / (walk.density + light.incident_pdf(ray.origin, ray.direction));
}

} // namespace vdbeam
