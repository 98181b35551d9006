#include "estimators/gather/final_gather.h"

#include "math/sampling.h"
#include "medium/distance_sampling.h"
#include "medium/optical_depth.h"
#include "transport/next_event.h"
#include "tuning/constants.h"

#include <cmath>

namespace vdbeam {

/// A walk on its way. Light that travels against its flight counts `throughput` times.
struct FinalGather::Walk : CameraWalk {
  Walk(const Rng& numbers, const Rgb& weight, RenderStatistics& counts_)
      : CameraWalk(numbers, weight), counts(counts_) {}

  RenderStatistics& counts;
  Vec3f beginning;
  int scatterings = 1;
  bool mirrored = false; ///< the present flight begins at a mirror or glass
  GatheredLight found;

  /// Light that comes along the present flight.
  void add(const GroupedLight& light) {
    (scatterings == 1 ? found.direct : found.indirect) += light;
  }
};

FinalGather::FinalGather(const World& world, const PhotonPlan& plan, const Maps& maps,
                         const SurfaceLighting& surfaces)
    : world_(world), plan_(plan), maps_(maps), surfaces_(surfaces),
      light_draw_(world.lights, plan.sampled_lights), shells_(world, plan.sampled_lights),
      lamps_(world, shells_),
      meets_light_(!world.medium.emitters.empty() || world.lights.any_extent()) {}

GatheredLight FinalGather::gather(const Ray& ray, const DepthProfile& profile, int walks,
                                  float ray_weight, Rng& rng, RenderStatistics& counts,
                                  const RaySink& sink) const {
  const Medium& medium = world_.medium;
  DistanceSampler distances(medium, ray, profile);
  const float expected = static_cast<float>(walks) * plan_.effort_of(profile.opacity());
  if (const float all = std::floor(expected); all < static_cast<float>(walks))
    walks = static_cast<int>(all) + (rng.uniform() < expected - all);
  const float stratum = 1 / static_cast<float>(walks);
  GatheredLight sum;
  for (int i = 0; i < walks; ++i) {
    const float u = std::min(1.0f, (static_cast<float>(i) + rng.uniform()) * stratum);
    const int c = medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
    if (!(distances.opacity(c) > 0))
      continue;
    const ScatterPoint point = distances.sample(u, c);
    const std::optional<VolumeChoice> chosen = choose_volume(point, rng.uniform());
    if (!chosen)
      continue;
    const Volume& volume = medium.volumes[chosen->volume];
    float weight = 1;
    const Vec3f direction =
        draw_direction({point.position, ray.direction}, volume.phase_index, true, rng, weight);
    Walk walk(rng, chosen->weight * std::abs(weight), counts);
    walk.beginning = point.position;
    set_out(walk, Vec3d(point.position), direction);
    follow(walk);
    rng = walk.rng;
    ++counts.gather_walks;
    const float counted = std::copysign(ray_weight / expected, weight);
    const Rgb light = (walk.found.direct.sum() + walk.found.indirect.sum()) * counted;
    sink.add(point.t, volume.setting, light);
    sum.direct += walk.found.direct *= counted;
    sum.indirect += walk.found.indirect *= counted;
    sum.blur += walk.found.blur * counted;
  }
  return sum;
}

/// The direction of the flight after a scattering at the origin of `arriving`, against the light.
/// `weight` is multiplied by phase function over density, which may be negative at the first
/// scattering.
Vec3f FinalGather::draw_direction(const Ray& arriving, int phase_index, bool first, Rng& rng,
                                  float& weight) const {
  const Medium& medium = world_.medium;
  const auto i = static_cast<std::size_t>(phase_index);
  const PhaseFunction &drawn = medium.phases[i],
                      &value = first ? medium.gathered_phases()[i] : drawn;
  const float evenly = first && medium.peak ? tuning::evenly_drawn : 0;
  const LampDirections::Vertex lamps = lamps_.at(arriving.origin);
  std::optional<Vec3f> direction;
  if (lamps_.any())
    direction = lamps.sample(rng);
  if (!direction) {
    const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    direction = evenly > 0 && rng.uniform() < evenly
                    ? sample_sphere(u, v)
                    : drawn.sample(arriving.direction, u_lobe, u, v);
  }
  const float to_lamps = lamps.chance();
  if (!(evenly > 0 || to_lamps > 0))
    return *direction;
  const float cosine = dot(arriving.direction, *direction);
  const float own = (1 - evenly) * drawn.evaluate(cosine) + evenly / (4 * pi);
  const float pdf = (1 - to_lamps) * own + lamps.density(*direction);
  weight *= value.evaluate(cosine) / pdf;
  return *direction;
}

/// Follows the walk to its end.
void FinalGather::follow(Walk& walk) const {
  for (bool goes_on = advance_flight(walk, *this); goes_on;)
    goes_on = step_flight(world_.medium, walk, *this);
}

/// Begins a flight, which ends at the first surface, and adds the light of lamps that it passes.
void FinalGather::set_out(Walk& walk, const Vec3d& origin, const Vec3f& direction,
                          bool mirrored) const {
  walk.mirrored = mirrored;
  walk.CameraWalk::set_out(world_, origin, direction);
  if (shells_.any())
    walk.found.indirect +=
        shells_.along(walk.segment, walk.rng, walk.counts.shadow_rays) * walk.throughput;
}

void FinalGather::meet(Walk& walk, const Collision& hit) const {
  if (meets_light_)
    gather_light(walk, hit.t, hit.t);
}

/// The flight leaves the medium, and with it the walk ends unless a mirror or glass sends it on.
bool FinalGather::leave(Walk& walk) const {
  gather_light(walk, walk.segment.t_end, walk.end ? static_cast<float>(walk.end->t) : infinity);
  return walk.end && meet_surface(walk);
}

bool FinalGather::collide(Walk& walk, const Collision& hit) const {
  const Medium& medium = world_.medium;
  const Volume& volume = *hit.volume;
  const auto phase = static_cast<std::size_t>(volume.phase_index);
  const Vec3f point = walk.segment.ray.at(hit.t);
  walk.segment.ray.origin = point;
  ++walk.scatterings;
  const bool last = walk.scatterings > tuning::most_scatterings_of_walk ||
                    length(point - walk.beginning) >= far_enough(volume);
  if (last)
    gather_photons(walk, volume, maps_.photons);
  else if (maps_.caustics)
    gather_photons(walk, volume, *maps_.caustics);
  walk.throughput *= volume.albedo_at(point);
  send_shadow_rays(walk, medium.gathered_phases()[phase]);
  if (last || !survive_roulette(tuning::roulette_below, walk.throughput, walk.rng))
    return false;
  float weight = 1;
  const Vec3f direction =
      draw_direction(walk.segment.ray, volume.phase_index, false, walk.rng, weight);
  walk.throughput *= weight;
  set_out(walk, Vec3d(point), direction);
  return advance_flight(walk, *this);
}

/// Whether the flight, where it meets a light, is what finds its light: straight, if shadow rays do
/// not; after a mirror or glass, unless the light is narrow and left to photons (caustic_lights).
bool FinalGather::finds(const Walk& walk, std::size_t light) const {
  return walk.mirrored ? !world_.lights[light].narrow_direction() : !plan_.sampled_lights[light];
}

void FinalGather::gather_light(Walk& walk, float medium_end, float t_end) const {
  walk.add(meet_light(world_, walk, medium_end, t_end,
                      [&](std::size_t light) { return finds(walk, light) ? 1.0f : 0.0f; }));
}

/// The light of the surface at which the flight ends. At a mirror or glass the walk goes on.
bool FinalGather::meet_surface(Walk& walk) const {
  const Vec3f& direction = walk.segment.ray.direction;
  const SurfaceVertex vertex(*world_.surfaces, *walk.end, direction);
  const Material& material = vertex.material();
  const bool goes_on = material.is_specular() && !material.is_black();
  GroupedLight light;
  if (!goes_on)
    light = surfaces_.reflected(vertex, direction, walk.rng);
  if (vertex.light() >= 0 && finds(walk, static_cast<std::size_t>(vertex.light())))
    light.add(vertex.emitted(), group_of(world_, vertex));
  walk.add(light * walk.throughput);
  if (!goes_on)
    return false;
  const MaterialSample next = vertex.sample(Carried::radiance, walk.rng);
  walk.throughput *= vertex.absorbed() * next.weight;
  if (!survive_roulette(tuning::roulette_below, walk.throughput, walk.rng) ||
      !walk.surfaces.survive(walk.throughput, walk.rng))
    return false;
  set_out(walk, vertex.hit().leave(next.wi), next.wi, true);
  return true;
}

/// Scattered light of lights with shadow rays at the walk's collision.
void FinalGather::send_shadow_rays(Walk& walk, const PhaseFunction& phase) const {
  const Ray& flight = walk.segment.ray;
  const MediumVertex vertex{flight.origin, flight.direction, phase};
  std::vector<DrawnLight> drawn;
  light_draw_.draw(
      vertex, walk.rng, [&](std::size_t l) { return shells_.holds(l, flight.origin); }, drawn);
  for (const auto& [l, weight] : drawn) {
    const auto direct = sample_direct_light(world_, world_.lights[l], vertex, walk.rng);
    if (!direct)
      continue;
    ++walk.counts.shadow_rays;
    RatioTracking shadow(world_.medium, direct->segment);
    while (shadow.advance(walk.rng) && shadow.attenuate(walk.rng))
      continue;
    walk.found.indirect.add(direct->light * shadow.transmittance() * walk.throughput *
                                direct->scattered * weight,
                            world_.lights.group(l));
  }
}

/// Scattered light of photons at the walk's collision. The power of photons may contain the
/// volume's albedo already.
void FinalGather::gather_photons(Walk& walk, const Volume& volume, const PhotonMap& map) const {
  const std::vector<PhaseFunction>& phases = world_.medium.gathered_phases();
  const auto phase = static_cast<std::size_t>(volume.phase_index);
  const std::size_t part = world_.medium.part_of(volume);
  std::vector<Rgb> gathered(phases.size()), groups;
  const Ray& at = walk.segment.ray;
  const auto query = [&](const PhotonMap& photons, std::vector<Rgb>* of_groups) {
    walk.counts.contributions +=
        photons
            .query_point(at.origin, at.direction, part, phases, gathered.data(), nullptr, of_groups)
            .contributions;
  };
  const Rgb albedo = plan_.albedo_in_power ? Rgb(1) : volume.albedo_at(at.origin);
  query(map, map.groups() > 0 ? &groups : nullptr);
  GroupedLight light(gathered[phase], groups, phase, phases.size());
  light *= albedo;
  light *= walk.throughput;
  if (maps_.compared && &map == &maps_.photons) {
    query(*maps_.compared, nullptr);
    walk.found.blur = light.sum() - gathered[phase] * albedo * walk.throughput;
  }
  walk.found.indirect += light;
}

} // namespace vdbeam
