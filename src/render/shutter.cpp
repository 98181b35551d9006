#include "render/shutter.h"

#include "machine/memory.h"
#include "machine/stopwatch.h"
#include "prepare/prepared_scene.h"

#include <algorithm>

namespace vdbeam {
namespace {

std::uint64_t bytes_of(const World& world) {
  std::uint64_t bytes = 0;
  for (const Volume& volume : world.medium.volumes)
    bytes += volume.field.bytes() + (volume.color ? volume.color->bytes() : 0);
  for (const Emitter& emitter : world.medium.emitters)
    bytes += emitter.field->bytes();
  return bytes;
}

/// Input for a motion sample: that of the scene, with photons of its own.
EstimatorTask task_of(const EstimatorTask& scene, const PreparedScene& moment) {
  EstimatorTask task = scene;
  task.photons = moment.photons.get();
  return task;
}

} // namespace

Shutter::MomentRenderer::MomentRenderer(const PreparedScenePtr& prepared_, const Camera& camera_,
                                        const EstimatorInput& from, const RenderPlan& path_plan)
    : prepared(prepared_), camera(camera_),
      input(*prepared->world, camera, from.settings, from.plan, task_of(from, *prepared)),
      path_input(input.with(path_plan)) {}

Shutter::Shutter(const Scene& scene, const EstimatorType& type, const PreparedScenePtr& prepared,
                 const EstimatorInput& input, const RenderPlan& path_plan,
                 const std::vector<std::size_t>& probe_pixels)
    : scene_(scene), type_(type), prepared_(prepared), input_(input), path_plan_(path_plan),
      probe_pixels_(probe_pixels) {}

Shutter::Renderer Shutter::at(int pass, RenderStatistics& statistics) {
  const bool still = scene_.moments.empty();
  const Scene& moment =
      still ? scene_
            : scene_.moments[motion_sample(pass, scene_.moments.size(), scene_.render.seed)];
  MomentRenderer& renderer = renderer_of(moment, statistics);
  renderer.last_pass = pass;
  if (!renderer.passes) {
    const Stopwatch watch;
    renderer.passes = ready_ ? std::move(ready_) : make_pass_renderer(type_, renderer.input);
    const Surfaces* surfaces = renderer.input.world.surfaces.get();
    if (renderer.input.plan.needs(Stage::bias) && !(surfaces && surfaces->focus_light()))
      renderer.probe =
          std::make_unique<BiasProbe>(renderer.path_input, renderer.input.window, probe_pixels_);
    return_freed_memory();
    statistics.pilot += watch.seconds();
    if (renderer.prepared->world != prepared_->world)
      add_work(statistics, *renderer.prepared);
  }
  // Estimators were made with the scene's own camera: what they plan must not depend on which pass
  // comes first.
  if (!still)
    renderer.camera = Camera(moment.camera, scene_.image, renderer.prepared->world->space);
  return {*renderer.passes, renderer.probe.get()};
}

void Shutter::follow(SceneChoices choices, RenderStatistics& statistics) {
  statistics.pilot_paths += choices.choices.photons.pilot_paths;
  statistics.importance_rays += choices.choices.photons.importance_rays;
  scene_choices_ = std::move(choices);
}

/// What moments follow; none where they choose for themselves. It depends on the scene alone,
/// never on which moment came first.
const std::optional<SceneChoices>& Shutter::scene_choices(RenderStatistics& statistics) {
  if (!input_.plan.needs(Stage::photon_importance) || scene_choices_)
    return scene_choices_;
  const Stopwatch watch;
  follow(choose_for_scene(input_, estimator_kind(type_)), statistics);
  statistics.pilot += watch.seconds();
  return scene_choices_;
}

Shutter::MomentRenderer& Shutter::renderer_of(const Scene& moment, RenderStatistics& statistics) {
  const std::string key = &moment == &scene_ ? "" : moved_world_settings(moment, *prepared_);
  std::unique_ptr<MomentRenderer>& renderer = renderers_[key];
  if (!renderer) {
    const PreparedScenePtr prepared =
        &moment == &scene_
            ? prepared_
            : prepare_scene(moment, prepared_, input_.stop ? *input_.stop : StopToken());
    renderer = std::make_unique<MomentRenderer>(
        prepared, Camera(scene_.camera, scene_.image, prepared->world->space), input_, path_plan_);
    if (&moment != &scene_)
      if (const auto& choices = scene_choices(statistics)) {
        renderer->scene_choices = choices->in_units(prepared->world->space.scale);
        renderer->input.of_scene = &*renderer->scene_choices;
      }
    if (input_.layers) {
      renderer->layers.emplace(input_.layers->at(moment));
      renderer->input.layers = &*renderer->layers;
    }
    make_room();
    return *renderers_[key];
  }
  return *renderer;
}

/// Drops the worlds that were used longest ago where all take more than a quarter of the memory.
void Shutter::make_room() {
  std::uint64_t bytes = prepared_->source_bytes();
  for (const auto& [key, renderer] : renderers_)
    bytes += bytes_of(*renderer->prepared->world);
  while (renderers_.size() > 2 && bytes > granted_memory() / 4) {
    const auto oldest =
        std::min_element(renderers_.begin(), renderers_.end(), [](const auto& a, const auto& b) {
          const bool a_used = a.second->passes != nullptr, b_used = b.second->passes != nullptr;
          return a_used != b_used ? a_used : a.second->last_pass < b.second->last_pass;
        });
    if (!oldest->second->passes)
      return;
    bytes -= bytes_of(*oldest->second->prepared->world);
    renderers_.erase(oldest);
  }
}

} // namespace vdbeam
