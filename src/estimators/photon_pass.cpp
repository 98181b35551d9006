#include "estimators/photon_pass.h"

#include "estimators/blur_probe.h"
#include "estimators/photon_cache.h"
#include "machine/memory.h"
#include "machine/stopwatch.h"

#include <cmath>
#include <utility>

namespace vdbeam {

PhotonPass::PhotonPass(const EstimatorInput& input, PhotonPlan (*make_plan)(const EstimatorInput&),
                       KernelDomain domain)
    : input_(input), worlds_(input.world, default_photon_plan(input).similar),
      world_(&worlds_.of(0)), plan_(make_plan(input.in(*world_))),
      boundary_share_(boundary_share(input, domain)),
      final_share_(boundary_share(input, KernelDomain::ball)) {
  const World& world = *world_;
  if (input.plan.needs(Stage::photons) && !plan_.trial) // kernels were tried for the paths it has
    plan_.paths = paths_with_hidden_lights(input.in(world), plan_);
  const double rays_per_pixel = shadow_rays_per_pixel(input.of_scene != nullptr);
  if (input.plan.needs(Stage::shadow_rays) && !world.medium.empty() && !world.medium.chromatic &&
      !input.stopped())
    shadows_ = make_shadow_lattices(world, plan_.sampled_lights,
                                    rays_per_pixel * static_cast<double>(input.camera.width()) *
                                        input.camera.height());
}

double PhotonPass::shadow_rays_per_pixel(bool of_moment) {
  return of_moment ? 1.0 / 16 : 2;
}

/// The pilot belongs to no pass; its counts go with the first.
void PhotonPass::count_pilot(RenderStatistics& statistics) {
  if (std::exchange(pilot_counted_, true))
    return;
  statistics.pilot_paths += plan_.pilot_paths;
  statistics.importance_rays += plan_.importance_rays;
}

void PhotonPass::trace_and_build(int pass, RenderStatistics& statistics) {
  const bool walks = plan_.gathers_finally(pass);
  world_ = &worlds_.of(pass, walks);
  compared_map_ = {};
  const World& world = *world_;
  const RadiusSettings radii = radius_settings(input_.in(world), plan_, pass);
  if (!input_.plan.needs(Stage::photons) && !input_.plan.needs(Stage::surface_photons)) {
    maps_.medium = PhotonMap::build({}, 1, radii, input_.settings.kernel_shape);
    return;
  }
  count_pilot(statistics);
  // Only the boundary's correction depends on the camera.
  make_maps(pass, radii, statistics);
  const Stopwatch watch;
  clear_of_surfaces(world, maps_.medium);
  const KernelShare& share = walks ? final_share_ : boundary_share_;
  if (input_.blur_pixels) {
    compared_map_ =
        maps_.medium.resized(walks ? BlurProbe::width_of_walks : BlurProbe::width_along_rays);
    compared_map_.divide_power(share);
  }
  maps_.medium.divide_power(share);
  statistics.radii += watch.seconds();
  statistics.photons_stored += maps_.medium.size();
  const bool adaptive = input_.plan.needs(Stage::neighbours);
  statistics.neighbourhoods += adaptive ? maps_.medium.size() : 0;
  statistics.neighbours = adaptive ? static_cast<double>(radii.neighbours) : 0;
  statistics.directions += maps_.medium.has_directions() ? maps_.medium.size() : 0;
  if (maps_.medium.size() > 0)
    statistics.bytes_per_photon = maps_.medium.bytes() / maps_.medium.size();
}

/// The maps of a pass: an earlier frame's, or new ones.
void PhotonPass::make_maps(int pass, const RadiusSettings& radii, RenderStatistics& statistics) {
  const EstimatorInput input = input_.in(*world_);
  PhotonPassSettings settings = pass_settings(input, plan_, static_cast<std::uint64_t>(pass));
  const bool on_surfaces = input_.plan.needs(Stage::surface_photons);
  if (on_surfaces)
    settings.surface_photon_lights = lights_of_surfaces(input);
  if (!input_.plan.needs(Stage::photons))
    settings.store_probability = 0;
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
  const bool stopped = input_.stopped();
  if (stopped)
    traced = {}; // of an abandoned pass, nobody needs the map
  statistics.light_paths += settings.paths;
  statistics.light_collisions += static_cast<std::uint64_t>(
      std::llround(traced.mean_collisions * static_cast<double>(settings.paths)));
  maps_.medium = PhotonMap::build(std::move(traced.photons), input_.photon_channels(), radii,
                                  input_.settings.kernel_shape);
  statistics.order += maps_.medium.times().order;
  statistics.radii += maps_.medium.times().radii;
  statistics.build += maps_.medium.times().build;
  if (on_surfaces)
    maps_.surfaces =
        PhotonMap::build(std::move(traced.surface_photons), input_.photon_channels(),
                         surface_radii(input, plan_, pass), input_.settings.kernel_shape);
  if (cache && !stopped)
    cache->keep(settings, radii, maps_);
}

} // namespace vdbeam
