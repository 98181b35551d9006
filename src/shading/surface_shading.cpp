#include "shading/surface_shading.h"

#include "math/mean_of_light.h"
#include "medium/emission.h"
#include "medium/optical_depth.h"
#include "rays/caught_shadow.h"
#include "rays/direct_light.h"
#include "rays/profile_shading.h"
#include "tuning/constants.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbeam {

namespace {

/// Random paths that go on from each camera ray that ends at a surface.
constexpr int paths_per_ray = 4;
/// Interfaces beyond the first at which a path goes both ways.
constexpr int most_splits = 1;
/// A smaller share of the light is not worth a path of its own.
constexpr float least_share = 1e-3f;

bool go_both_ways(const SpecularBranches& ways) {
  return max_component(ways.reflected.weight) > least_share &&
         max_component(ways.refracted.weight) > least_share;
}

/// Number of the paths from the first interface that take a branch with this share of the light; at
/// least one takes each branch.
int paths_by_share(const Rgb& share) {
  const long paths = std::lround(paths_per_ray * max_component(share));
  return std::clamp(static_cast<int>(paths), 1, paths_per_ray - 1);
}

int reflected_paths(const SpecularBranches& ways) {
  return go_both_ways(ways) ? paths_by_share(ways.reflected.weight) : 0;
}

/// Rough glass seen from outside.
bool is_frosted(const SurfaceVertex& vertex) {
  const Material& material = vertex.material();
  return material.refracts() && !material.is_specular() && vertex.front();
}

/// Smooth glass sends a path both ways. Rough glass does so inside, where what it reflects, a few
/// percent, comes out somewhere else and may then show a lamp; outside shadow rays find the lamps
/// that it reflects.
bool splits_light(const SurfaceVertex& vertex) {
  const Material& material = vertex.material();
  return material.is_specular() || (material.refracts() && !vertex.front());
}

/// One of the ways, by its share of the light.
MaterialSample one_of(const SpecularBranches& ways, Rng& rng) {
  const float reflected = max_component(ways.reflected.weight),
              both = reflected + max_component(ways.refracted.weight);
  const bool reflects = rng.uniform() * both < reflected;
  MaterialSample way = reflects ? ways.reflected : ways.refracted;
  if (both > 0)
    way.weight *= both / (reflects ? reflected : both - reflected);
  return way;
}

} // namespace

/// A camera ray that goes on from surface to surface.
struct SurfaceShading::Chain {
  Rng& rng;
  RenderStatistics& counts;
  Rgb throughput;
  Vec3d origin{}; ///< of the present segment
  Vec3f direction{};
  float pdf = 0;   ///< with which the direction was drawn; 0: nothing else draws it
  float scale = 1; ///< factor of the throughput that is no loss: roulette looks beyond it
  int splits = most_splits;
  bool lamps_found = false; ///< at the next surface, if it is rough glass or metal
  SurfaceRoulette length{};

  /// Follows one of several branches at a surface; the others are followed too.
  void take_share(const SurfaceVertex& vertex, const MaterialSample& way) {
    leave(vertex, way);
    scale *= max_component(way.weight);
  }
  /// Leaves it the only way that is followed.
  void take_all(const SurfaceVertex& vertex, const MaterialSample& way) {
    leave(vertex, way);
    scale *= way.refraction;
  }
  bool survives_roulette() {
    return survive_roulette(tuning::roulette_below * scale, throughput, rng);
  }

private:
  void leave(const SurfaceVertex& vertex, const MaterialSample& way) {
    throughput *= way.weight;
    origin = vertex.hit().leave(way.wi);
    direction = way.wi;
    pdf = way.pdf;
  }
};

SurfaceShading::SurfaceShading(const EstimatorInput& input, const PhotonPass& photons,
                               const SurfaceLighting& surfaces, GatherAlong gather)
    : input_(input), world_(photons.world()), photons_(photons), gather_(std::move(gather)),
      surfaces_(surfaces), matt_(world_, photons.plan(), surfaces),
      cutoff_(static_cast<float>(input.settings.cutoff)) {}

SeenSurface SurfaceShading::seen(const CameraRay& camera, const RngKey& key, std::size_t stream,
                                 RenderStatistics& counts) const {
  if (!camera.hit)
    return {};
  const auto path_rng = [&](int i) {
    return Rng(key, RngStage::surface, stream * paths_per_ray + static_cast<std::size_t>(i));
  };
  const SurfaceVertex vertex(*world_.surfaces, *camera.hit, camera.ray().direction);
  if (vertex.material().is_shadow_catcher()) {
    Rng rng = path_rng(0);
    SeenSurface seen{.caught = caught_shadow(world_, camera, rng)};
    if (input_.layers && input_.layers->tells_added_light())
      seen.added = surfaces_.added_to_plate(vertex, camera.ray().direction, rng).sum();
    return seen;
  }
  if (vertex.material().shows_surroundings())
    return shown_by(vertex, path_rng, counts);
  return matt_.seen(vertex, key, stream);
}

/// Reflected and refracted light of the first surface: the mean over a few paths. Glass sends some
/// of them either way.
template <class PathRng>
SeenSurface SurfaceShading::shown_by(const SurfaceVertex& vertex, const PathRng& path_rng,
                                     RenderStatistics& counts) const {
  if (is_frosted(vertex))
    return {shown_by_frosted(vertex, path_rng, counts)};
  const SpecularBranches ways = vertex.branches(Carried::radiance);
  const int reflected = reflected_paths(ways), refracted = paths_per_ray - reflected;
  if (reflected == 0)
    return shown_one_way(vertex, path_rng, counts);
  GroupedLight sum;
  for (int i = 0; i < paths_per_ray; ++i) {
    Rng rng = path_rng(i);
    Chain chain{rng, counts, vertex.absorbed()};
    chain.take_share(vertex, i < reflected ? ways.reflected : ways.refracted);
    sum += follow(chain) / static_cast<float>(i < reflected ? reflected : refracted);
  }
  return {sum};
}

/// Mirrors and metal: each path draws its direction. Reflections in metal that is not smooth are
/// fitted over pixels as far as they are noise.
template <class PathRng>
SeenSurface SurfaceShading::shown_one_way(const SurfaceVertex& vertex, const PathRng& path_rng,
                                          RenderStatistics& counts) const {
  MeanOfLight mean;
  for (int i = 0; i < paths_per_ray; ++i) {
    Rng rng = path_rng(i);
    Chain chain{rng, counts, vertex.absorbed()};
    GroupedLight light = scatter(vertex, chain);
    light += follow(chain);
    mean.add(light);
  }
  SeenSurface seen{mean.mean()};
  seen.gloss_color = vertex.texture();
  if (vertex.material().is_specular() || !shows_light(seen.gloss_color))
    return seen;
  seen.gloss = seen.radiance / seen.gloss_color;
  seen.gloss_variance = mean_component(mean.variance() / (seen.gloss_color * seen.gloss_color));
  seen.albedo = Rgb(1);
  locate(vertex, seen);
  return seen;
}

/// Frosted glass: each path draws a facet, at which it goes one way or the other.
template <class PathRng>
GroupedLight SurfaceShading::shown_by_frosted(const SurfaceVertex& vertex, const PathRng& path_rng,
                                              RenderStatistics& counts) const {
  int reflected = 0;
  GroupedLight sum;
  for (int i = 0; i < paths_per_ray; ++i) {
    Rng rng = path_rng(i);
    if (i == 0) // by a facet that no path uses
      reflected = paths_by_share(vertex.both_ways(Carried::radiance, rng).reflected.weight);
    Chain chain{rng, counts, vertex.absorbed()};
    sum += surfaces_.tracer().lights_at_surface(vertex, rng) * chain.throughput /
           static_cast<float>(paths_per_ray);
    const bool reflects = i < reflected;
    GroupedLight light;
    if (!reflects) {
      light = lamps_behind(vertex, rng) * chain.throughput;
      chain.lamps_found = true;
    }
    const SpecularBranches ways = vertex.both_ways(Carried::radiance, rng);
    const MaterialSample& way = reflects ? ways.reflected : ways.refracted;
    if (max_component(way.weight) > 0) {
      chain.take_share(vertex, way);
      light += follow(chain);
    }
    sum += light / static_cast<float>(reflects ? reflected : paths_per_ray - reflected);
  }
  return sum;
}

/// The light of lamps that the surface behind frosted glass scatters to it: where both have narrow
/// lobes, few rays are on their way to a lamp, and those are bright.
GroupedLight SurfaceShading::lamps_behind(const SurfaceVertex& vertex, Rng& rng) const {
  GroupedLight sum;
  for (int i = 0; i < tuning::lamp_rays; ++i) {
    const MaterialSample way = vertex.both_ways(Carried::radiance, rng).refracted;
    if (!(max_component(way.weight) > 0))
      continue;
    const CameraRay ray = ray_from_surface(world_, vertex.hit().leave(way.wi), way.wi);
    if (!ray.hit)
      continue;
    const SurfaceVertex next(*world_.surfaces, *ray.hit, way.wi);
    if (next.material().shows_surroundings() && !next.material().is_specular())
      sum += surfaces_.tracer().lights_at_surface(next, rng) * next.absorbed() * way.weight *
             exact_transmittance(world_.medium, ray.segment);
  }
  return sum / static_cast<float>(tuning::lamp_rays);
}

/// Sends the chain on from a surface; returns the light of lights that the surface reflects to it,
/// or what is seen the other way where it goes both ways.
GroupedLight SurfaceShading::scatter(const SurfaceVertex& vertex, Chain& chain) const {
  const bool specular = vertex.material().is_specular();
  GroupedLight light;
  if (!std::exchange(chain.lamps_found, false) && !specular)
    light = surfaces_.tracer().lights_at_surface(vertex, chain.rng) * chain.throughput;
  if (chain.splits > 0 && splits_light(vertex)) {
    const SpecularBranches ways = vertex.both_ways(Carried::radiance, chain.rng);
    if (go_both_ways(ways)) {
      --chain.splits;
      Chain other = chain;
      other.take_share(vertex, ways.reflected);
      chain.take_share(vertex, ways.refracted);
      return light + follow(other);
    }
    if (!specular) { // to draw anew would be biased
      chain.take_all(vertex, one_of(ways, chain.rng));
      return light;
    }
  }
  chain.take_all(vertex, vertex.sample(Carried::radiance, chain.rng));
  return light;
}

/// Radiance of the chain from its present segment on, times its throughput.
GroupedLight SurfaceShading::follow(Chain chain) const {
  GroupedLight sum;
  DepthProfile profile;
  while (chain.survives_roulette() && chain.length.survive(chain.throughput, chain.rng)) {
    const CameraRay ray = ray_from_surface(world_, chain.origin, chain.direction);
    profile.build(world_.medium, ray.segment, cutoff_);
    const Rgb tr = transmittance(world_.medium, profile);
    const Rgb lamps = left_of_lamps(profile);
    sum += along(ray, profile, tr, chain) * chain.throughput;
    chain.throughput *= tr;
    if (!ray.hit || !chain.survives_roulette())
      return sum;
    const SurfaceVertex vertex(*world_.surfaces, *ray.hit, chain.direction);
    if (!vertex.material().shows_surroundings())
      return sum + at_end(vertex, lamps, chain) * chain.throughput;
    chain.throughput *= vertex.absorbed();
    sum += scatter(vertex, chain);
  }
  return sum;
}

/// The radiance that a segment of the chain adds. Light that only the peak of the phase function
/// scatters comes with that which goes straight on, but for lights with shadow rays, where
/// direct_light has it.
GroupedLight SurfaceShading::along(const CameraRay& ray, const DepthProfile& profile, const Rgb& tr,
                                   Chain& chain) const {
  const std::vector<bool>& sampled_lights = photons_.plan().sampled_lights;
  const bool has_peak = world_.medium.peak && !profile.empty();
  const auto weight = [&](std::size_t i) {
    const Light& light = world_.lights[i];
    return sampled_too(i, chain)
               ? chain.pdf / (chain.pdf + light.incident_pdf(ray.ray().origin, chain.direction))
               : 1.0f;
  };
  GroupedLight radiance =
      lights_through(world_, ray.whole(), profile, tr, false, [&](std::size_t i) {
        return has_peak && sampled_lights[i] ? 0.0f : weight(i);
      });
  if (has_peak)
    radiance += lights_through(input_.world, ray.whole(),
                               profile.scaled(world_.medium.peak->extinction_factor),
                               tr * left_of_lamps(profile), false,
                               [&](std::size_t i) { return sampled_lights[i] ? weight(i) : 0.0f; });
  if (!ray.segment.empty())
    radiance.add(emission_along(world_.medium, ray.segment, profile, cutoff_),
                 world_.lights.group_of_emission());
  if (!profile.empty())
    radiance += in_scattered(ray, profile, chain.rng, chain.counts);
  return radiance;
}

/// The transmittance of the scene's own medium over that of the medium at hand.
Rgb SurfaceShading::left_of_lamps(const DepthProfile& profile) const {
  if (!world_.medium.peak || profile.empty())
    return Rgb(1);
  return transmittance_of(profile.taken_out(world_.medium, profile.knots() - 1));
}

/// Radiance that leaves the surface at which the chain ends. `lamps`: transmittance on the way
/// there for lights with shadow rays over that for others.
GroupedLight SurfaceShading::at_end(const SurfaceVertex& vertex, const Rgb& lamps,
                                    Chain& chain) const {
  Rgb emitted(1);
  if (const int light = vertex.light(); light >= 0) {
    const auto i = static_cast<std::size_t>(light);
    if (sampled_too(i, chain))
      emitted *=
          chain.pdf / (chain.pdf + world_.lights[i].surface_pdf(vertex.hit(), chain.direction));
    if (photons_.plan().sampled_lights[i])
      emitted *= lamps;
  }
  return GroupedLight(vertex.emitted() * emitted, group_of(world_, vertex)) +
         surfaces_.reflected(vertex, chain.direction, chain.rng);
}

/// The surface that the segment leaves has sent a shadow ray to this light as well.
bool SurfaceShading::sampled_too(std::size_t light, const Chain& chain) const {
  return chain.pdf > 0 && surfaces_.tracer().samples_light(light);
}

/// Light that the medium scatters into the ray: once, by shadow rays; else by photons.
GroupedLight SurfaceShading::in_scattered(const CameraRay& ray, const DepthProfile& profile,
                                          Rng& rng, RenderStatistics& counts) const {
  ++counts.depth_profiles;
  GroupedLight sum = direct_light(world_, ray.ray(), profile,
                                  {photons_.plan().sampled_lights, 1, &photons_.shadows()}, rng,
                                  counts.shadow_rays);
  if (photons_.map().size() > 0) {
    ++counts.lookups;
    sum += gather_(ray, profile, rng);
  }
  return sum;
}

} // namespace vdbeam
