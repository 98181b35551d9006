#include "photons/photon_pass.h"

#include "machine/memory.h"
#include "machine/stopwatch.h"
#include "photons/blur_probe.h"
#include "photons/photon_cache.h"
#include "tuning/constants.h"

#include <cmath>

namespace vdbeam {

PhotonPass::PhotonPass(const EstimatorInput& input, PassWorlds& worlds, const World& first,
                       const PhotonPlan& plan)
    : input_(input), worlds_(worlds), world_(&first), plan_(plan) {
  const World& world = first;
  const double rays_per_pixel = shadow_rays_per_pixel(input.of_scene != nullptr);
  if (plan.shadow_lattices && !input.stopped())
    shadows_ = make_shadow_lattices(world, plan_.sampled_lights,
                                    rays_per_pixel * static_cast<double>(input.camera.width()) *
                                        input.camera.height());
}

double PhotonPass::shadow_rays_per_pixel(bool of_moment) {
  return of_moment ? 1.0 / 16 : 2;
}

void PhotonPass::trace_and_build(const PassSpec& spec, KernelDomain domain,
                                 RenderStatistics& statistics) {
  world_ = &worlds_.of(spec.peak_order);
  compared_map_ = {};
  caustics_along_rays_ = {};
  const World& world = *world_;
  const RadiusSettings radii =
      radius_settings(input_.in(world), spec.neighbours, spec.kernel_scale);
  if (!input_.plan.needs(Stage::photons) && !input_.plan.needs(Stage::surface_photons)) {
    maps_.medium = PhotonMap::build({}, 1, radii, input_.settings.kernel_shape);
    input_.begin_step(RenderStep::pass);
    return;
  }
  input_.begin_step(RenderStep::photons);
  // Only the boundary's correction depends on the camera.
  make_maps(spec, radii, statistics);
  const Stopwatch watch;
  const auto fit = [&](KernelDomain over, PhotonMap& map) {
    fit_kernels(input_, over, plan_.share_at_boundary, map);
  };
  if (maps_.caustics.size() > 0) {
    caustics_along_rays_ = maps_.caustics.copy();
    fit(KernelDomain::disc, caustics_along_rays_);
    fit(KernelDomain::ball, maps_.caustics);
  }
  if (input_.blur_pixels) {
    compared_map_ = maps_.medium.resized(
        domain == KernelDomain::ball ? BlurProbe::width_of_walks : BlurProbe::width_along_rays);
    fit(domain, compared_map_);
  }
  fit(domain, maps_.medium);
  input_.check_stop();
  statistics.radii += watch.seconds();
  statistics.photons_stored += maps_.medium.size();
  const bool adaptive = input_.plan.needs(Stage::neighbours);
  statistics.neighbourhoods += adaptive ? maps_.medium.size() : 0;
  statistics.neighbours = adaptive ? static_cast<double>(radii.neighbours) : 0;
  statistics.directions += maps_.medium.has_directions() ? maps_.medium.size() : 0;
  if (maps_.medium.size() > 0)
    statistics.bytes_per_photon = maps_.medium.bytes() / maps_.medium.size();
  input_.begin_step(RenderStep::pass);
}

/// The maps of a pass: an earlier frame's, or new ones.
void PhotonPass::make_maps(const PassSpec& spec, const RadiusSettings& radii,
                           RenderStatistics& statistics) {
  const EstimatorInput input = input_.in(*world_);
  PhotonPassSettings settings = pass_settings(input, plan_, static_cast<std::uint64_t>(spec.pass));
  settings.paths = spec.light_paths;
  const bool on_surfaces = input_.plan.needs(Stage::surface_photons);
  if (on_surfaces)
    settings.surface_photon_lights = lights_of_surfaces(input);
  if (!input_.plan.needs(Stage::photons))
    settings.store_probability = 0;
  if (spec.gather_walks > 0)
    settings.caustic_lights = caustic_lights(*world_);
  PhotonCache* cache = input_.photons;
  if (const auto kept = cache ? cache->find(settings, radii) : nullptr) {
    maps_ = kept->copy();
    ++statistics.maps_reused;
    return;
  }
  const Stopwatch watch;
  TracedPhotons traced = trace_photons(*world_, settings);
  return_freed_memory(); // the threads' own lists, as large as the one that was made of them
  statistics.trace += watch.seconds();
  statistics.light_paths += settings.paths;
  input_.check_stop();
  statistics.light_collisions += static_cast<std::uint64_t>(
      std::llround(traced.mean_collisions * static_cast<double>(settings.paths)));
  RadiusSettings of_caustics = radii;
  of_caustics.neighbours = tuning::caustic_neighbours;
  maps_.caustics = PhotonMap::build(std::move(traced.caustics), input_.photon_channels(),
                                    of_caustics, input_.settings.kernel_shape, input_.stop);
  maps_.medium = PhotonMap::build(std::move(traced.photons), input_.photon_channels(), radii,
                                  input_.settings.kernel_shape, input_.stop);
  statistics.order += maps_.medium.times().order;
  statistics.radii += maps_.medium.times().radii;
  statistics.build += maps_.medium.times().build;
  if (on_surfaces)
    maps_.surfaces = PhotonMap::build(std::move(traced.surface_photons), input_.photon_channels(),
                                      surface_radii(input, spec.kernel_scale),
                                      input_.settings.kernel_shape, input_.stop);
  input_.check_stop();
  if (cache)
    cache->keep(settings, radii, maps_);
}

} // namespace vdbeam
