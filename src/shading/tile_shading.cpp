#include "shading/tile_shading.h"

#include "shading/peak_light.h"
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
  GroupedLight light =
      light_of_the_peak(world, ray, surface.radiance - surface.lamp, plan.sampled_lights, sink);
  if (samples > 0)
    light += direct_light(world, ray.camera.ray(), ray.profile,
                          {plan.sampled_lights, samples, &photons.shadows(), input.stop, weight},
                          rng, counts.shadow_rays, sink);
  sink.add_sum(&PassImage::direct, light);
  return medium;
}

SurfaceLighting surface_lighting(const EstimatorInput& input, const PhotonPass& photons) {
  const bool on_surfaces = input.plan.needs(Stage::surface_photons);
  return {input, photons.world(), on_surfaces ? &photons.surface_map() : nullptr};
}

namespace {

/// The camera's side of one pass, tile by tile.
class TileShader {
public:
  TileShader(const EstimatorInput& input, const PhotonPass& photons, const PassSpec& spec,
             const TileGather& tiles, PassImage& image)
      : input_(input), photons_(photons), world_(photons.world()), spec_(spec), tiles_(tiles),
        image_(image), key_{input.settings.seed, input.frame,
                            static_cast<std::uint64_t>(spec.pass)},
        lighting_(surface_lighting(input, photons)) {
    if (!world_.surfaces)
      return;
    input_.window = widened(wanted(input), SurfaceFit::reach, input.camera);
    fit_.emplace(input_, spec);
    surfaces_.emplace(input_, photons, lighting_, tiles.gather_along);
  }

  void shade(RenderStatistics& statistics) {
    input_.resize(image_);
    tbb::enumerable_thread_specific<TileScratch> scratches;
    for_each_tile(input_, image_,
                  [&](int x0, int y0, int, int) { shade_tile(x0, y0, scratches.local()); });
    RenderStatistics sums;
    for (const TileScratch& scratch : scratches)
      sums += scratch.statistics;
    // Stage seconds are processor seconds of the tiles, shared out over the threads that worked.
    const double threads = static_cast<double>(std::max<std::size_t>(1, scratches.size()));
    for (double* seconds : {&sums.profile, &sums.direct, &sums.query})
      *seconds /= threads;
    statistics += sums;
    statistics.camera_rays += static_cast<std::uint64_t>(image_.width) * image_.height;
  }
  /// Replaces the light of surfaces by what is fitted over pixels.
  void fit_surfaces(const PixelRegion& window) {
    if (fit_ && !input_.stopped())
      fit_->apply(window, image_, tiles_.blur);
  }

private:
  template <class Work>
  void for_rays(const TileScratch& scratch, const Work& work) const {
    for (int i = 0; i < TileRays::count && !input_.stopped(); ++i)
      if (const TileRays::PixelRay& ray = scratch.rays[i]; ray.inside)
        work(ray, static_cast<std::size_t>(i));
  }

  void shade_tile(int x0, int y0, TileScratch& scratch) {
    Stopwatch watch;
    scratch.rays.prepare(input_.in(world_), key_, x0, y0);
    scratch.statistics.profile += watch.restart();
    const bool shows_surface = scratch.rays.show_surface();
    scratch.effort.fill(1);
    if (surfaces_)
      see_surfaces(scratch);
    for_rays(scratch, [&](const TileRays::PixelRay& ray, std::size_t i) {
      const SeenSurface& surface = scratch.seen[i];
      if (fit_)
        set_surface(ray, surface, shows_surface ? &scratch.ends[i] : nullptr);
      scratch.medium[i] =
          shade_ray(input_, photons_, ray, key_, {ray.pixel, image_, scratch.statistics}, surface,
                    scratch.effort[i]);
    });
    if (tiles_.refine_medium || shows_surface) {
      scratch.uneven = uneven_pixels(input_, world_, scratch, tiles_.refine_medium, shows_surface);
      refine_edges(scratch);
    }
    scratch.statistics.direct += watch.restart();
    if (photons_.map().size() > 0 && !input_.stopped())
      tiles_.gather(scratch, key_);
    scratch.statistics.query += watch.seconds();
  }

  /// The surfaces at the ends of a tile's rays, matt ones by more samples where they are noisy, and
  /// the effort on shafts of light before them.
  void see_surfaces(TileScratch& scratch) const {
    scratch.seen.fill({});
    for_rays(scratch, [&](const TileRays::PixelRay& ray, std::size_t i) {
      scratch.seen[i] = surfaces_->seen(ray.camera, key_, ray.stream, scratch.statistics);
    });
    const auto more =
        more_samples(input_.world.medium, scratch.rays, scratch.seen, spec_.expected_passes);
    for_rays(scratch, [&](const TileRays::PixelRay& ray, std::size_t i) {
      if (scratch.seen[i].surface >= 0)
        surfaces_->matt().add(ray.camera, more[i], key_, ray.stream, scratch.seen[i]);
    });
    if (photons_.plan().chooses_direct_samples)
      scratch.effort =
          shaft_effort(world_, photons_.plan().sampled_lights, scratch.rays, scratch.seen, key_);
  }

  /// Gives the fit what a ray sees of a surface, and `end`, unless it is null, the light there.
  void set_surface(const TileRays::PixelRay& ray, const SeenSurface& surface, EndOfRay* end) {
    const Rgb tr = transmittance(world_.medium, ray.profile);
    fit_->set(ray.pixel, surface, ray.camera.air ? tr * air_to_end(ray.camera).left : tr);
    if (end)
      *end = {mean_component(light_of_end(world_, ray, surface, tr)), ray.camera.hit.has_value()};
  }

  /// Gives the tile's uneven pixels, which one ray each has shaded, the mean over several.
  void refine_edges(TileScratch& scratch) {
    for_rays(scratch, [&](const TileRays::PixelRay& own, std::size_t i) {
      if (!scratch.uneven[i])
        return;
      const std::size_t pixel = own.pixel;
      OpacityAndDepth& medium = scratch.medium[i];
      int rays = 1;
      const int index = static_cast<int>(i);
      scratch.rays.refine(input_.in(world_), key_, index);
      for (const TileRays::PixelRay& ray : scratch.rays.more(index)) {
        const SeenSurface surface =
            surfaces_ ? surfaces_->seen(ray.camera, key_, ray.stream, scratch.statistics)
                      : SeenSurface();
        if (fit_)
          fit_->add(pixel, surface,
                    transmittance(world_.medium, ray.profile) * air_to_end(ray.camera).left,
                    rays++);
        const OpacityAndDepth seen =
            shade_ray(input_, photons_, ray, key_, {pixel, image_, scratch.statistics}, surface,
                      scratch.effort[i] / TileRays::rays_if_refined);
        medium.opacity += seen.opacity;
        medium.depth += seen.depth;
      }
      constexpr float weight = 1.0f / TileRays::rays_if_refined;
      image_.scale_pixel(pixel, weight);
      medium = {medium.opacity * weight, medium.depth * weight};
      scratch.statistics.camera_rays += TileRays::rays_if_refined - 1;
    });
  }

  EstimatorInput input_;
  const PhotonPass& photons_;
  const World& world_; ///< of the map: rays that gather share its medium
  const PassSpec& spec_;
  const TileGather& tiles_;
  PassImage& image_;
  RngKey key_;
  SurfaceLighting lighting_;
  std::optional<SurfaceFit> fit_; ///< only among surfaces
  std::optional<SurfaceShading> surfaces_;
};

} // namespace

void shade_tiles(const EstimatorInput& input, const PhotonPass& photons, const PassSpec& spec,
                 const TileGather& tiles, PassImage& image, RenderStatistics& statistics) {
  TileShader shader(input, photons, spec, tiles, image);
  shader.shade(statistics);
  shader.fit_surfaces(wanted(input));
}

} // namespace vdbeam
