#include "vdbeam/render.h"

#include "estimators/estimator.h"
#include "estimators/pilot/choose_estimator.h"
#include "film/deep_film.h"
#include "layers/light_group_names.h"
#include "layers/plane_layers.h"
#include "machine/memory.h"
#include "machine/stopwatch.h"
#include "machine/threads.h"
#include "plan/memory_check.h"
#include "plan/plan.h"
#include "prepare/prepared_scene.h"
#include "rays/make_deep_layout.h"
#include "render/limit_notes.h"
#include "render/pass_loop.h"
#include "render/shutter.h"
#include "render/sight.h"
#include "transport/camera_ray.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

namespace vdbeam {
namespace {

/// The pixels that are wanted, counted from the corner of the overscan. A region counts from that
/// of the picture.
PixelRegion choose_window(const ImageSettings& image, const std::optional<PixelRegion>& region) {
  const int o = image.overscan;
  const PixelRegion window =
      region.value_or(PixelRegion{-o, -o, image.width + o, image.height + o});
  if (window.empty() || window.x0 < -o || window.y0 < -o || window.x1 > image.width + o ||
      window.y1 > image.height + o)
    throw InputError(fmt::format("the region {},{},{},{} must hold a pixel and lie within the "
                                 "picture of {} x {}{}",
                                 window.x0, window.y0, window.x1, window.y1, image.width,
                                 image.height, o > 0 ? " and its overscan" : ""));
  return {window.x0 + o, window.y0 + o, window.x1 + o, window.y1 + o};
}

/// Greatest length of a deep sample [world].
double deep_depth(const ImageSettings& image, const World& world) {
  constexpr double pieces = 16; // of the medium's diameter
  return image.deep_depth > 0
             ? image.deep_depth
             : 2 * static_cast<double>(world.region.radius) / world.space.scale / pieces;
}

void check_range(const std::optional<PassRange>& range) {
  if (range && (range->first < 0 || range->last < range->first))
    throw InputError(fmt::format("the pass range {}-{} must begin at 0 or above and not end before "
                                 "its beginning",
                                 range->first, range->last));
}

} // namespace

RenderResult render(const Scene& scene, const FrameSettings& frame, const RenderHooks& hooks) {
  validate_scene(scene);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(thread_count(scene.render)));
  return render(scene, prepare_scene(scene), frame, hooks);
}

RenderResult render(const Scene& asked, const PreparedScenePtr& prepared,
                    const FrameSettings& frame, const RenderHooks& hooks) {
  validate_scene(asked);
  Scene scene = asked;
  check_range(frame.pass_range);
  const PixelRegion window = choose_window(scene.image, frame.region);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(thread_count(scene.render)));
  RenderResult result;
  const auto note = [&](const std::string& line) {
    result.notes.push_back(line);
    if (hooks.on_note)
      hooks.on_note(line);
  };
  const World& world = *prepared->world;
  for (const std::string& line : prepared->facts.notes)
    note(line);
  add_work(result.statistics, *prepared);
  const Camera camera(scene.camera, scene.image, world.space);
  const std::vector<VolumeFacts> volumes =
      volume_facts(prepared->facts, world, camera, !scene.moments.empty());
  const auto with_sizes = [&](RenderPlan plan) {
    plan.surface_bytes = world.surfaces ? world.surfaces->bytes() : 0;
    plan.film_bytes = film_memory(scene.image, window.width(), window.height(), scene.glows(),
                                  light_group_names(scene).size(),
                                  scene.image.cryptomatte ? scene_objects(scene).names.size() : 0,
                                  plane_names(scene).size());
    return plan;
  };
  result.plan = with_sizes(plan_stages(scene, volumes));
  check_memory(scene, result.plan, granted_memory());
  // Correlated frames all draw the numbers of frame 1.
  const bool correlated = scene.render.seeds == SeedPolicy::correlated;
  const std::uint64_t key = correlated ? 1 : static_cast<std::uint64_t>(scene.frame.number);
  PassLoop loop(scene, frame, hooks, window, result);
  EstimatorInput input(world, camera, scene.render, result.plan,
                       {key, window, &loop.stop_token(), prepared->photons.get()});
  std::vector<std::size_t> blur_pixels;
  if (result.plan.needs(Stage::bias) && result.plan.needs(Stage::beam_query)) {
    blur_pixels = choose_blur_pixels(window, camera.width(), loop.probe_pixels());
    input.blur_pixels = &blur_pixels;
  }
  SceneObjects objects;
  if (scene.image.cryptomatte) {
    objects = scene_objects(scene);
    input.objects = &objects;
  }
  Velocities velocities;
  for (const ReadVolume& volume : prepared->volumes)
    velocities.push_back(volume.velocity);
  const RayLayers layers(scene, velocities);
  if (layers.planes() > 0)
    input.layers = &layers;
  DeepLayout deep;
  if (scene.image.deep) {
    const std::uint64_t granted = granted_memory();
    deep = make_deep_layout(
        input, scene.image.deep_alpha, deep_depth(scene.image, world), [&](std::size_t pieces) {
          check_deep_memory(scene, pieces * DeepFilm::bytes_per_piece(), granted);
        });
    if (!deep.first.empty()) { // else there was no time for it, and there is none for passes
      loop.gather_deep(deep);
      input.deep = &deep;
    }
  }
  const RenderPlan path_plan = with_sizes(plan_paths(scene, volumes));
  const EstimatorInput path_input = input.with(path_plan);
  loop.show_quick_look(path_input);
  Shutter shutter(scene, prepared, input, path_plan, loop.probe_pixels());
  if (scene.render.estimator == EstimatorType::automatic) {
    const Stopwatch watch;
    EstimatorChoice choice = choose_estimator(input, path_input);
    result.statistics.pilot += watch.seconds();
    scene.render.estimator = choice.type;
    if (choice.type == EstimatorType::path) {
      result.plan = path_plan;
      input.blur_pixels = nullptr;
    }
    result.plan.estimator = choice.type.name;
    result.plan.choice = choice.reason;
    if (choice.type == EstimatorType::path)
      note(fmt::format("render.estimator = \"auto\" takes path: {}", choice.reason));
    if (choice.beam && light_group_names(scene).empty()) {
      if (scene.moments.empty())
        shutter.take(std::move(choice.beam));
      else
        shutter.follow({{choice.beam->photons().plan(), world.space}}, result.statistics);
    }
  }
  for (const std::string& line : limit_notes(scene, input))
    note(line);
  const Sight sight = look_through(world, camera, window);
  for (const std::string& line : sight_notes(scene, world, camera, sight))
    note(line);
  if (scene.moments.empty())
    shutter.at(0, result.statistics); // its pilot does not count as part of a pass
  loop.run(shutter, path_input);
  if (result.quick_look || frame.pass_range)
    return result;
  result.picture = picture_facts(result.image, sight);
  if (!scene.lights.empty() || scene.glows()) // the scene's own note says that there is no light
    for (const std::string& line : picture_notes(result.picture))
      note(line);
  return result;
}

} // namespace vdbeam
