#include "transport/next_event.h"
#include "walks/walk_tracer.h"

#include <utility>

// What walks do at surfaces.

namespace vdbeam {

GroupedLight WalkTracer::from_surface(const SurfaceHit& hit, const Vec3f& direction, Rng& rng,
                                      bool all_light, bool emits, WalkCounts* counts) const {
  const SurfaceVertex vertex(*world_.surfaces, hit, direction);
  PathWalk first(rng, vertex.absorbed());
  first.all_light = all_light;
  GroupedLight sum;
  if (emits)
    sum.add(vertex.emitted(), group_of(world_, vertex));
  sum += follow_from(vertex, first, counts);
  rng = first.rng; // for what the caller draws next
  return sum;
}

/// The walk's first direction decides which share of the light that comes from there the matt part
/// reflects.
ReflectedLight WalkTracer::reflected(const SurfaceVertex& vertex, Rng& rng, bool all_light) const {
  PathWalk first(rng, vertex.absorbed());
  first.all_light = all_light;
  first.least_weight = roulette_from(Rgb(1));
  ReflectedLight light;
  const bool leaves = bounce(first, vertex, true, &light.straight.matt);
  const GroupedLight straight = first.direct;
  const Rgb share = leaves ? vertex.matt_share(first.segment.ray.direction) : Rgb();
  const GroupedLight beyond = follow(first, leaves, nullptr) - straight;
  light.beyond.matt = beyond * share;
  if (!vertex.material().is_all_matt()) {
    light.straight.gloss = straight - light.straight.matt;
    light.beyond.gloss = beyond - light.beyond.matt;
  }
  rng = first.rng;
  return light;
}

GroupedLight WalkTracer::added_to_plate(const SurfaceHit& hit, const Vec3f& direction, Rng& rng,
                                        bool all_light) const {
  const SurfaceVertex vertex(*world_.surfaces, hit, direction);
  PathWalk first(rng, vertex.absorbed());
  first.all_light = all_light;
  first.in_plate = true;
  const GroupedLight sum = follow_from(vertex, first, nullptr);
  rng = first.rng;
  return sum;
}

/// Light of a walk that begins at a surface.
GroupedLight WalkTracer::follow_from(const SurfaceVertex& vertex, PathWalk& first,
                                     WalkCounts* counts) const {
  first.least_weight = roulette_from(Rgb(1));
  const bool leaves = bounce(first, vertex, true);
  return follow(first, leaves, counts);
}

/// Light of a walk after its first surface, and of its branches, with what it has so far.
GroupedLight WalkTracer::follow(PathWalk& first, bool leaves, WalkCounts* counts) const {
  GroupedLight sum;
  std::vector<PathWalk> branches;
  const auto follow_walk = [&](PathWalk& walk, bool goes_on) {
    for (; goes_on; goes_on = step(walk, branches))
      if (counts)
        ++counts->steps;
    if (counts)
      counts->shadow_rays += walk.shadow_rays;
    sum += walk.direct + walk.indirect;
  };
  follow_walk(first, leaves && advance_flight(first, *this));
  while (!branches.empty()) {
    PathWalk walk = std::move(branches.back());
    branches.pop_back();
    follow_walk(walk, true);
  }
  return sum;
}

/// Adds the light of the surface at which the flight ends; false where the walk ends there.
bool WalkTracer::meet_surface(PathWalk& walk) const {
  const Vec3f& direction = walk.segment.ray.direction;
  const SurfaceVertex vertex(*world_.surfaces, *walk.end, direction);
  walk.throughput *= vertex.absorbed();
  if (vertex.light() >= 0 && max_component(vertex.emitted()) > 0) {
    const auto light = static_cast<std::size_t>(vertex.light());
    const bool sampled = shadow_rays_[light];
    float weight = sampled && walk.leaves_out(world_.lights[light]) ? 0 : 1;
    if (sampled && walk.density > 0)
      weight *=
          walk.density / (walk.density + world_.lights[light].surface_pdf(*walk.end, direction));
    walk.add(vertex.emitted() * walk.throughput * weight, group_of(world_, vertex));
  }
  return bounce(walk, vertex, false);
}

/// Scatters the walk at a surface, at its first vertex or a later one. False where it ends.
bool WalkTracer::bounce(PathWalk& walk, const SurfaceVertex& vertex, bool is_first,
                        GroupedLight* matt) const {
  const Material& material = vertex.material();
  if (material.is_black())
    return false;
  walk.in_plate = walk.in_plate && material.is_shadow_catcher();
  const bool counts_straight =
      !material.is_specular() && (walk.all_light || is_first || !material.throws_light());
  if (counts_straight) {
    walk.shadow_rays += light_draw_.usual_count();
    walk.add(lights_at_surface(vertex, walk.rng, true, walk.in_plate, matt) * walk.throughput);
  }
  if (matt)
    *matt *= walk.throughput;
  const MaterialSample next = leave_surface(vertex, walk.rng);
  walk.throughput *= next.weight;
  walk.refraction *= next.refraction;
  if (!survive_roulette(walk.least_weight * walk.refraction, walk.throughput, walk.rng) ||
      !walk.surfaces.survive(walk.throughput, walk.rng))
    return false;
  walk.density = next.pdf;
  walk.skips_sampled = walk.from_medium = false;
  walk.from_surface = counts_straight;
  set_out(walk, vertex.hit().leave(next.wi), next.wi);
  look_into_shells(walk);
  return true;
}

/// Half of the walks leave a surface towards what glows in the medium.
bool WalkTracer::looks_for_emission(const SurfaceVertex& vertex) const {
  const Material& material = vertex.material();
  return world_.emission && !material.is_specular() && !material.refracts();
}

/// Density with which a walk leaves a surface in this direction.
float WalkTracer::surface_density(const SurfaceVertex& vertex, const Vec3f& wi) const {
  const float own = vertex.pdf(wi);
  if (!looks_for_emission(vertex))
    return own;
  return 0.5f * (own + world_.emission->pdf(Vec3f(vertex.hit().position), wi));
}

/// Draws the direction in which a walk leaves a surface.
MaterialSample WalkTracer::leave_surface(const SurfaceVertex& vertex, Rng& rng) const {
  if (!looks_for_emission(vertex))
    return vertex.sample(Carried::radiance, rng);
  MaterialSample next;
  if (rng.uniform() < 0.5f) {
    const auto towards = world_.emission->sample(Vec3f(vertex.hit().position), rng);
    if (!towards)
      return {};
    next.wi = towards->wi;
  } else {
    next = vertex.sample(Carried::radiance, rng);
    if (!(max_component(next.weight) > 0))
      return {};
  }
  next.pdf = surface_density(vertex, next.wi);
  next.weight = next.pdf > 0 ? vertex.evaluate(next.wi) / next.pdf : Rgb();
  // A faint walk that was sent to bright light on purpose is no loss.
  if (const float own = vertex.pdf(next.wi); own < next.pdf)
    next.refraction *= std::max(own / next.pdf, 1e-6f);
  return next;
}

GroupedLight WalkTracer::lights_at_surface(const SurfaceVertex& vertex, Rng& rng,
                                           bool goes_on_as_walk, bool in_plate,
                                           GroupedLight* matt) const {
  GroupedLight sum;
  std::vector<DrawnLight> drawn;
  light_draw_.draw(
      vertex, rng, [&](std::size_t i) { return in_plate && world_.lights.in_plate(i); }, drawn);
  for (const auto& [i, weight] : drawn) {
    const auto direct =
        sample_direct_light(world_, world_.lights[i], vertex, rng, [&](const Vec3f& wi) {
          return goes_on_as_walk ? surface_density(vertex, wi) : vertex.pdf(wi);
        });
    if (!direct)
      continue;
    const Rgb light = direct->radiance() * weight *
                      estimate_transmittance(world_.medium, direct->segment, rng.uniform());
    sum.add(light, world_.lights.group(i));
    if (matt)
      matt->add(light * vertex.matt_share(direct->direction()), world_.lights.group(i));
  }
  return sum;
}

} // namespace vdbeam
