#include "render/frame_setup.h"

#include "choose/feature.h"
#include "choose/plan_numbers.h"
#include "choose/schedule.h"
#include "layers/plane_layers.h"
#include "lights/light_groups.h"
#include "photons/photon_plan.h"
#include "prepare/read_volumes.h"
#include "render/bias_probe.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Correlated frames all draw the numbers of frame 1.
std::uint64_t frame_key(const Scene& scene) {
  const bool correlated = scene.render.seeds == SeedPolicy::correlated;
  return correlated ? 1 : static_cast<std::uint64_t>(scene.frame.number);
}

Velocities velocities_of(const PreparedScene& prepared) {
  Velocities velocities;
  for (const ReadVolume& volume : prepared.volumes)
    velocities.push_back(volume.velocity);
  return velocities;
}

} // namespace

FrameSetup::FrameSetup(const Scene& scene, const PreparedScenePtr& prepared,
                       const PixelRegion& window)
    : scene_(scene), prepared_(prepared), window_(window),
      camera(scene.camera, scene.image, prepared->world->space),
      volumes_(volume_facts(prepared->facts, *prepared->world, camera, !scene.moments.empty())),
      plan(with_sizes(plan_stages(scene, volumes_))),
      path_plan(with_sizes(plan_paths(scene, volumes_))), layers(scene, velocities_of(*prepared)),
      input(*prepared->world, camera, scene.render, plan,
            {frame_key(scene), window, nullptr, prepared->photons.get()}) {
  if (scene.image.cryptomatte) {
    objects_ = scene_objects(scene);
    input.objects = &objects_;
  }
  if (layers.planes() > 0)
    input.layers = &layers;
  input.reaches_bounce_limit = reach_bounce_limit(input);
}

RenderPlan FrameSetup::with_sizes(RenderPlan sized) const {
  sized.surface_bytes = world().surfaces ? world().surfaces->bytes() : 0;
  sized.film_bytes = film_memory(scene_.image, window_.width(), window_.height(), scene_.glows(),
                                 light_group_names(scene_).size(),
                                 scene_.image.cryptomatte ? scene_objects(scene_).names.size() : 0,
                                 plane_names(scene_).size());
  return sized;
}

void FrameSetup::probe_blur(const std::vector<std::size_t>& probes) {
  if (!plan.needs(Stage::bias) || !plan.needs(Stage::beam_query))
    return;
  blur_pixels_ = choose_blur_pixels(window_, camera.width(), probes);
  input.blur_pixels = &blur_pixels_;
}

void describe_choices(const EstimatorInput& input, const EstimatorType& type,
                      const Choices& choices, RenderPlan& plan) {
  plan.features = describe_features(input, estimator_kind(type), choices);
  plan.schedule = list_passes(choices, input.settings);
  plan.numbers = describe_numbers(input, choices, plan.schedule);
}

} // namespace vdbeam
