#include "shading/tile_shading.h"

#include "shading/shaft_effort.h"
#include "shading/surface_fit.h"

#include "machine/stopwatch.h"
#include "rays/direct_light.h"
#include "rays/pixel_tiles.h"
#include "rays/profile_shading.h"
#include "rays/uneven_pixels.h"
#include "tuning/constants.h"

#include <tbb/enumerable_thread_specific.h>

namespace vdbeam {

namespace {

/// Where on the ray the peak scatters light last that comes along it from behind: at the distance t
/// the light is `radiance` times 1 - exp(-excess(t)) in all so far.
void add_light_of_the_peak(const World& world, const DepthProfile& profile, const Rgb& radiance,
                           const DeepRay& deep) {
  ProfileCursor cursor(profile);
  Rgb before;
  for (std::size_t i = 0; i < deep.count(); ++i) {
    cursor.move_to(std::min(deep.end(i), profile.back()));
    Rgb after, light;
    for (std::size_t v = 0; v < profile.volume_count(); ++v)
      after += world.medium.peak->excess[profile.volume(v)] * cursor.tau(v);
    for (int c = 0; c < 3; ++c)
      light[c] = radiance[c] * std::exp(-before[c]) * opacity_of(after[c] - before[c]);
    deep.add_light(i, light);
    before = after;
  }
}

/// The same, by the volumes that scatter it.
void add_light_of_the_peak(const World& world, const DepthProfile& profile, const Rgb& radiance,
                           const VolumeLights& volumes) {
  const std::vector<Rgb>& excess = world.medium.peak->excess;
  Rgb before;
  for (std::size_t knot = 1; knot < profile.knots(); ++knot) {
    Rgb after;
    for (std::size_t v = 0; v < profile.volume_count(); ++v)
      after += excess[profile.volume(v)] * profile.tau(knot, v);
    for (std::size_t v = 0; v < profile.volume_count(); ++v) {
      const Rgb own = excess[profile.volume(v)] * (profile.tau(knot, v) - profile.tau(knot - 1, v));
      Rgb light;
      for (int c = 0; c < 3; ++c)
        if (const float all = after[c] - before[c]; all > 0)
          light[c] = radiance[c] * std::exp(-before[c]) * opacity_of(all) * own[c] / all;
      volumes.add(world.medium.volumes[profile.volume(v)].setting, light);
    }
    before = after;
  }
}

/// What the air lets through of light that the peak scatters for the last time: mean over the ray.
Rgb air_before_peak(const World& world, const DepthProfile& profile) {
  Rgb before, sum, left;
  for (std::size_t knot = 1; profile.air() && knot < profile.knots(); ++knot) {
    Rgb after;
    for (std::size_t v = 0; v < profile.volume_count(); ++v)
      after += world.medium.peak->excess[profile.volume(v)] * profile.tau(knot, v);
    const Rgb air = profile.air().left(0.5f * (profile.t(knot - 1) + profile.t(knot)));
    for (int c = 0; c < 3; ++c) {
      const float light = std::exp(-before[c]) * opacity_of(after[c] - before[c]);
      sum[c] += light;
      left[c] += air[c] * light;
    }
    before = after;
  }
  for (int c = 0; c < 3; ++c)
    left[c] = sum[c] > 0 ? left[c] / sum[c] : 1;
  return left;
}

/// Light of surfaces and of surrounding lights that only the peak of the phase function scattered
/// on its way along the ray: what the medium without its peak lets through beyond what the scene's
/// own does. Lights with shadow rays have theirs from these.
GroupedLight light_of_the_peak(const World& world, const TileRays::PixelRay& ray,
                               const SeenSurface& surface, const std::vector<bool>& sampled_lights,
                               const RaySink& sink) {
  GroupedLight radiance;
  if (!world.medium.peak || ray.profile.empty())
    return radiance;
  radiance = surface.radiance - surface.lamp;
  radiance *= air_to_end(ray.camera).left;
  const Rgb air = air_before_peak(world, ray.profile);
  for (std::size_t i = 0; i < world.lights.size(); ++i)
    if (!sampled_lights[i])
      radiance.add(world.lights[i].emitted_radiance(ray.camera.whole()).radiance * air,
                   world.lights.group(i));
  const std::size_t last = ray.profile.knots() - 1;
  const Rgb tau = ray.profile.channels(world.medium, last);
  Rgb excess;
  for (std::size_t v = 0; v < ray.profile.volume_count(); ++v)
    excess += world.medium.peak->excess[ray.profile.volume(v)] * ray.profile.tau(last, v);
  Rgb through, scattered;
  for (int c = 0; c < 3; ++c) {
    through[c] = radiance.sum()[c] * std::exp(-tau[c]);
    scattered[c] = std::exp(-tau[c]) * opacity_of(excess[c]);
  }
  radiance *= scattered;
  if (sink.deep)
    add_light_of_the_peak(world, ray.profile, through, sink.deep);
  if (sink.volumes)
    add_light_of_the_peak(world, ray.profile, through, sink.volumes);
  return radiance;
}

/// What the rays of a tile see, row by row.
class TileEdges {
public:
  TileEdges(const TileScratch& scratch, int image_width, int image_height)
      : x0_(scratch.rays.x0()), y0_(scratch.rays.y0()),
        width_(std::min(tile_width, image_width - x0_)),
        height_(std::min(tile_width, image_height - y0_)) {
    const auto width = static_cast<std::size_t>(image_width);
    for (std::size_t i = 0; i < TileRays::count; ++i) {
      const TileRays::PixelRay& ray = scratch.rays[static_cast<int>(i)];
      if (!ray.inside)
        continue;
      const std::size_t index =
          seen_by().index(static_cast<int>(ray.pixel % width), static_cast<int>(ray.pixel / width));
      opacity_[index] = scratch.medium[i].opacity;
      depth_[index] = scratch.medium[i].depth;
      ends_[index] = scratch.ends[i];
    }
  }

  SeenMedium seen_by() const { return {x0_, y0_, width_, height_, opacity_.data(), depth_.data()}; }
  const EndOfRay* ends() const { return ends_.data(); }

private:
  int x0_, y0_, width_, height_;
  std::array<float, TileRays::count> opacity_{}, depth_{};
  std::array<EndOfRay, TileRays::count> ends_{};
};

/// Light that a ray meets at its end, by which edges are found: without what the surface there
/// reflects of other surfaces and the medium, which is noise, and with lights that the camera does
/// not see, so that hiding a sky changes nothing else. A shadow catcher shows what is not in
/// shadow.
Rgb light_of_end(const World& world, const TileRays::PixelRay& ray, const SeenSurface& surface,
                 const Rgb& tr) {
  Rgb light = surface.radiance.sum() - surface.smooth.sum() * surface.albedo -
              surface.gloss.sum() * surface.gloss_color;
  if (ray.camera.hit && world.surfaces->material(*ray.camera.hit).is_shadow_catcher())
    light = Rgb(1 - surface.caught.mean);
  return light * tr + lights_through(world, ray.camera.whole(), ray.profile, tr, false).sum();
}

/// Sets of shadow rays of a ray, and the factor of what they find: where less than one is due,
/// there is one by chance, or none.
std::pair<int, float> direct_samples(const PhotonPlan& plan, const TileRays::PixelRay& ray,
                                     float effort, Rng& rng) {
  if (ray.profile.empty())
    return {1, 1};
  const auto samples =
      static_cast<float>(plan.direct_samples_of(ray.profile.total(ray.profile.knots() - 1)));
  const float of_opacity = plan.effort_of(ray.profile.opacity());
  if (const float due = samples * of_opacity; due < 1)
    return {rng.uniform() < due, 1 / due};
  return {std::max(1, static_cast<int>(std::lround(samples * effort * of_opacity))), 1};
}

/// Which pixels of the tile lie on edges.
std::array<bool, TileRays::count> uneven_pixels(const EstimatorInput& input, const World& world,
                                                const TileScratch& scratch, bool refine_medium,
                                                bool refine_light) {
  const int width = input.camera.width();
  const TileEdges edges(scratch, width, input.camera.height());
  const SeenMedium seen = edges.seen_by();
  std::array<bool, TileRays::count> uneven{};
  for (std::size_t i = 0; i < TileRays::count; ++i) {
    const TileRays::PixelRay& ray = scratch.rays[static_cast<int>(i)];
    const int x = static_cast<int>(ray.pixel) % width, y = static_cast<int>(ray.pixel) / width;
    uneven[i] =
        ray.inside && ((refine_medium && is_uneven(seen, input.camera, world.space.scale, x, y)) ||
                       (refine_light && is_unevenly_lit(seen, edges.ends(), x, y)));
  }
  return uneven;
}

/// The surfaces at the ends of a tile's rays, matt ones by more samples where they are noisy.
void see_surfaces(const EstimatorInput& input, const SurfaceShading& surfaces, const RngKey& key,
                  int pass, TileScratch& scratch) {
  const auto for_rays = [&](const auto& work) {
    for (int i = 0; i < TileRays::count && !input.stopped(); ++i)
      if (const TileRays::PixelRay& ray = scratch.rays[i]; ray.inside)
        work(ray, static_cast<std::size_t>(i));
  };
  scratch.seen.fill({});
  for_rays([&](const TileRays::PixelRay& ray, std::size_t i) {
    scratch.seen[i] = surfaces.seen(ray.camera, key, ray.stream, scratch.statistics);
  });
  const auto more = more_samples(input.world.medium, scratch.rays, scratch.seen, pass);
  for_rays([&](const TileRays::PixelRay& ray, std::size_t i) {
    if (scratch.seen[i].surface >= 0)
      surfaces.matt().add(ray.camera, more[i], key, ray.stream, scratch.seen[i]);
  });
}

/// Gives the tile's uneven pixels, which one ray each has shaded, the mean over several.
void refine_edges(const EstimatorInput& input, const PhotonPass& photons,
                  const SurfaceShading* surfaces, SurfaceFit* fit, const RngKey& key,
                  TileScratch& scratch, PassImage& image) {
  const World& world = photons.world();
  for (int i = 0; i < TileRays::count && !input.stopped(); ++i) {
    if (!scratch.uneven[static_cast<std::size_t>(i)])
      continue;
    const std::size_t pixel = scratch.rays[i].pixel;
    OpacityAndDepth& medium = scratch.medium[static_cast<std::size_t>(i)];
    int rays = 1;
    scratch.rays.refine(input.in(world), key, i);
    for (const TileRays::PixelRay& ray : scratch.rays.more(i)) {
      const SeenSurface surface =
          surfaces ? surfaces->seen(ray.camera, key, ray.stream, scratch.statistics)
                   : SeenSurface();
      if (fit)
        fit->add(pixel, surface,
                 transmittance(world.medium, ray.profile) * air_to_end(ray.camera).left, rays++);
      const OpacityAndDepth seen =
          shade_ray(input, photons, ray, key, {pixel, image, scratch.statistics}, surface,
                    scratch.effort[static_cast<std::size_t>(i)] / TileRays::rays_if_refined);
      medium.opacity += seen.opacity;
      medium.depth += seen.depth;
    }
    constexpr float weight = 1.0f / TileRays::rays_if_refined;
    image.scale_pixel(pixel, weight);
    medium = {medium.opacity * weight, medium.depth * weight};
    scratch.statistics.camera_rays += TileRays::rays_if_refined - 1;
  }
}

} // namespace

OpacityAndDepth shade_ray(const EstimatorInput& input, const PhotonPass& photons,
                          const TileRays::PixelRay& ray, const RngKey& key,
                          const PixelTarget& target, const SeenSurface& surface, float effort) {
  const World& world = photons.world();
  RenderStatistics& counts = target.counts;
  PassImage& image = target.image;
  counts.depth_profiles += ray.profile.empty() ? 0 : 1;
  const PeakTakenOut* peak = world.medium.peak.get();
  const OpacityAndDepth medium =
      peak && !ray.profile.empty()
          ? shade_profile(input, ray.camera, ray.profile.scaled(peak->extinction_factor),
                          target.pixel, image, surface)
          : shade_profile(input, ray.camera, ray.profile, target.pixel, image, surface);
  shade_emission(input, world, ray.camera, ray.profile, target.pixel, image, counts.emission_rays);
  Rng rng(key, RngStage::direct, ray.stream);
  const PhotonPlan& plan = photons.plan();
  const RaySink sink(world, ray.camera, input.layers, target.pixel, image);
  const auto [samples, weight] = direct_samples(plan, ray, effort, rng);
  GroupedLight light = light_of_the_peak(world, ray, surface, plan.sampled_lights, sink);
  if (samples > 0)
    light += direct_light(world, ray.camera.ray(), ray.profile,
                          {plan.sampled_lights, samples, &photons.shadows(), input.stop, weight},
                          rng, counts.shadow_rays, sink);
  image.add(&PassImage::direct, target.pixel, light);
  return medium;
}

SurfaceLighting surface_lighting(const EstimatorInput& input, const PhotonPass& photons) {
  const bool on_surfaces = input.plan.needs(Stage::surface_photons);
  return {input, photons.world(), on_surfaces ? &photons.surface_map() : nullptr};
}

void shade_tiles(const EstimatorInput& task, const PhotonPass& photons, int pass,
                 const TileGather& tiles, PassImage& image, RenderStatistics& statistics) {
  const World& world = photons.world(); // of the map: rays that gather share its medium
  EstimatorInput input = task;
  std::optional<SurfaceFit> fit;
  if (world.surfaces) {
    input.window = widened(wanted(task), SurfaceFit::reach, task.camera);
    fit.emplace(input, pass);
  }
  input.resize(image);
  const RngKey key{input.settings.seed, input.frame, static_cast<std::uint64_t>(pass)};
  std::optional<SurfaceShading> surfaces;
  const SurfaceLighting lighting = surface_lighting(input, photons);
  if (world.surfaces)
    surfaces.emplace(input, photons, lighting, tiles.gather_along);
  tbb::enumerable_thread_specific<TileScratch> scratches;
  for_each_tile(input, image, [&](int x0, int y0, int, int) {
    TileScratch& scratch = scratches.local();
    Stopwatch watch;
    scratch.rays.prepare(input.in(world), key, x0, y0);
    scratch.statistics.profile += watch.restart();
    const bool shows_surface = scratch.rays.show_surface();
    if (surfaces)
      see_surfaces(input, *surfaces, key, pass, scratch);
    scratch.effort.fill(1);
    if (world.surfaces && photons.plan().chooses_direct_samples)
      scratch.effort =
          shaft_effort(world, photons.plan().sampled_lights, scratch.rays, scratch.seen, key);
    for (int i = 0; i < TileRays::count && !input.stopped(); ++i)
      if (const TileRays::PixelRay& ray = scratch.rays[i]; ray.inside) {
        const SeenSurface& surface = scratch.seen[static_cast<std::size_t>(i)];
        if (fit) {
          const Rgb tr = transmittance(world.medium, ray.profile);
          fit->set(ray.pixel, surface, ray.camera.air ? tr * air_to_end(ray.camera).left : tr);
          if (shows_surface)
            scratch.ends[static_cast<std::size_t>(i)] = {
                mean_component(light_of_end(world, ray, surface, tr)), ray.camera.hit.has_value()};
        }
        scratch.medium[static_cast<std::size_t>(i)] =
            shade_ray(input, photons, ray, key, {ray.pixel, image, scratch.statistics}, surface,
                      scratch.effort[static_cast<std::size_t>(i)]);
      }
    if (tiles.refine_medium || shows_surface) {
      scratch.uneven = uneven_pixels(input, world, scratch, tiles.refine_medium, shows_surface);
      refine_edges(input, photons, surfaces ? &*surfaces : nullptr, fit ? &*fit : nullptr, key,
                   scratch, image);
    }
    scratch.statistics.direct += watch.restart();
    if (photons.map().size() > 0 && !input.stopped())
      tiles.gather(scratch, key);
    scratch.statistics.query += watch.seconds();
  });
  if (fit && !input.stopped())
    fit->apply(wanted(task), image, tiles.blur);
  RenderStatistics sums;
  for (const TileScratch& scratch : scratches)
    sums += scratch.statistics;
  // Stage seconds are processor seconds of the tiles, shared out over the threads that worked.
  const double threads = static_cast<double>(std::max<std::size_t>(1, scratches.size()));
  for (double* seconds : {&sums.profile, &sums.direct, &sums.query})
    *seconds /= threads;
  statistics += sums;
  statistics.camera_rays += static_cast<std::uint64_t>(image.width) * image.height;
}

} // namespace vdbeam
