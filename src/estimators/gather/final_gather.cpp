#include "estimators/gather/final_gather.h"

#include "math/sampling.h"
#include "medium/distance_sampling.h"
#include "medium/emission.h"
#include "medium/optical_depth.h"
#include "medium/scattering.h"

#include <cmath>

namespace vdbeam {

namespace {

/// Walks end after so many scatterings at the latest, wherever they are: in very dense media
/// kernels are far wider than walks could go in reasonable time.
constexpr int most_scatterings = 8;
/// Share of first directions that are drawn evenly where a forward peak is taken out: the smooth
/// rest by which the camera sees may be negative, where the table of directions has next to none.
constexpr float evenly_drawn = 0.25f;

/// The way light takes to the camera from a direction of travel `ahead`, away from the camera: the
/// direction of the walk's first flight, and in `weight` phase function over density, which may be
/// negative.
Vec3f draw_first_direction(const Medium& medium, int phase_index, const Vec3f& ahead, Rng& rng,
                           float& weight) {
  const auto i = static_cast<std::size_t>(phase_index);
  const PhaseFunction& drawn = medium.phases[i];
  const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
  weight = 1;
  if (!medium.peak)
    return drawn.sample(ahead, u_lobe, u, v);
  const Vec3f direction =
      rng.uniform() < evenly_drawn ? sample_sphere(u, v) : drawn.sample(ahead, u_lobe, u, v);
  const float cosine = dot(ahead, direction);
  const float pdf = (1 - evenly_drawn) * drawn.evaluate(cosine) + evenly_drawn / (4 * pi);
  weight = medium.gathered_phases()[i].evaluate(cosine) / pdf;
  return direction;
}

} // namespace

/// A walk at the beginning of a flight. Light that travels against the flight counts `throughput`
/// times.
struct FinalGather::Walk {
  Rng& rng;
  RenderStatistics& counts;
  Vec3f beginning;
  Ray flight;
  Rgb throughput;
  int scatterings = 1;
  GatheredLight found = {};
};

FinalGather::FinalGather(const World& world, const PhotonPlan& plan, const PhotonMap& map,
                         const PhotonMap* compared)
    : world_(world), plan_(plan), map_(map), compared_(compared), far_enough_(map.mean_radius()),
      meets_light_(!world.medium.emitters.empty() || world.lights.any_extent()) {}

GatheredLight FinalGather::gather(const Ray& ray, const DepthProfile& profile, int walks,
                                  float ray_weight, Rng& rng, RenderStatistics& counts,
                                  const DeepRay& deep, const VolumeLights& of_volumes) const {
  const Medium& medium = world_.medium;
  DistanceSampler distances(medium, ray, profile);
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
        draw_first_direction(medium, volume.phase_index, ray.direction, rng, weight);
    Walk walk{rng,
              counts,
              point.position,
              {point.position, direction},
              chosen->weight * std::abs(weight)};
    follow(walk);
    ++counts.gather_walks;
    const float counted = std::copysign(stratum * ray_weight, weight);
    const Rgb light = (walk.found.direct + walk.found.indirect) * counted;
    deep.add_light_at(point.t, light);
    of_volumes.add(volume.setting, light);
    sum.direct += walk.found.direct * counted;
    sum.indirect += walk.found.indirect * counted;
    sum.blur += walk.found.blur * counted;
  }
  return sum;
}

/// Follows the walk to its end.
void FinalGather::follow(Walk& walk) const {
  const Medium& medium = world_.medium;
  while (const std::optional<Collision> hit = fly(walk)) {
    const Volume& volume = *hit->volume;
    const auto phase = static_cast<std::size_t>(volume.phase_index);
    const Vec3f point = walk.flight.at(hit->t), ahead = walk.flight.direction;
    walk.flight.origin = point;
    ++walk.scatterings;
    const bool last =
        walk.scatterings > most_scatterings || length(point - walk.beginning) >= far_enough_;
    if (last)
      gather_photons(walk, volume);
    walk.throughput *= volume.albedo_at(point);
    send_shadow_rays(walk, medium.gathered_phases()[phase]);
    if (last || !survive_roulette(roulette_below, walk.throughput, walk.rng))
      return;
    const float u_lobe = walk.rng.uniform(), u = walk.rng.uniform(), v = walk.rng.uniform();
    walk.flight.direction = medium.phases[phase].sample(ahead, u_lobe, u, v);
  }
}

/// The walk's next real collision; none where its flight leaves the medium.
std::optional<Collision> FinalGather::fly(Walk& walk) const {
  BoundedTracker tracker(world_.medium, {walk.flight});
  for (float begin = 0;;) {
    const Collision hit = tracker.next(walk.rng);
    if (meets_light_ || !hit.volume)
      meet_light(walk, begin, hit.t);
    if (!hit.volume)
      return std::nullopt;
    if (sample_real_collision(hit, world_.medium.chromatic, walk.throughput, walk.rng))
      return hit;
    begin = hit.t;
  }
}

/// Light that a piece of the flight meets: the medium's own, and that of lights for which there are
/// no shadow rays.
void FinalGather::meet_light(Walk& walk, float begin, float end) const {
  const Segment piece{walk.flight, begin, end};
  Rgb light;
  if (!world_.medium.emitters.empty())
    light += sample_emission(world_.medium, piece, walk.rng);
  for (std::size_t l = 0; l < world_.lights.size(); ++l)
    if (!plan_.sampled_lights[l] && !world_.lights[l].is_delta())
      light += world_.lights[l].emitted_radiance(piece).radiance;
  (walk.scatterings == 1 ? walk.found.direct : walk.found.indirect) += light * walk.throughput;
}

/// What the collision at the walk's place scatters of lights with shadow rays.
void FinalGather::send_shadow_rays(Walk& walk, const PhaseFunction& phase) const {
  const Ray& flight = walk.flight;
  for (std::size_t l = 0; l < world_.lights.size(); ++l) {
    if (!plan_.sampled_lights[l])
      continue;
    const float u = walk.rng.uniform(), v = walk.rng.uniform();
    const IncidentSample sample = world_.lights[l].sample_incident(flight.origin, u, v);
    if (!(max_component(sample.value) > 0))
      continue;
    ++walk.counts.shadow_rays;
    RatioTracking shadow(world_.medium, {{flight.origin, sample.wi}, 0, sample.distance});
    while (shadow.advance(walk.rng) && shadow.attenuate(walk.rng))
      continue;
    walk.found.indirect += sample.value * shadow.transmittance() * walk.throughput *
                           phase.evaluate(dot(flight.direction, sample.wi));
  }
}

/// What the collision at the walk's place scatters of the light that photons carry. The photons
/// may have its albedo already.
void FinalGather::gather_photons(Walk& walk, const Volume& volume) const {
  const std::vector<PhaseFunction>& phases = world_.medium.gathered_phases();
  const auto phase = static_cast<std::size_t>(volume.phase_index);
  std::vector<Rgb> gathered(phases.size());
  const auto radiance = [&](const PhotonMap& map) {
    const Ray& at = walk.flight;
    walk.counts.contributions +=
        map.query_point(at.origin, at.direction, phases, gathered.data()).contributions;
    const Rgb albedo = plan_.albedo_in_power ? Rgb(1) : volume.albedo_at(at.origin);
    return gathered[phase] * albedo * walk.throughput;
  };
  const Rgb light = radiance(map_);
  walk.found.indirect += light;
  if (compared_)
    walk.found.blur = light - radiance(*compared_);
}

} // namespace vdbeam
