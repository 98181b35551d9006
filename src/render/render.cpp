#include "vdbeam/render.h"

#include "estimators/camera_ray.h"
#include "estimators/estimator.h"
#include "machine/threads.h"
#include "render/limit_notes.h"
#include "render/memory_check.h"
#include "render/pass_loop.h"
#include "render/plan.h"
#include "render/prepared_scene.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>

namespace vdbeam {
namespace {

PixelRegion choose_window(const ImageSettings& image, const std::optional<PixelRegion>& region) {
  const PixelRegion window = region.value_or(PixelRegion{0, 0, image.width, image.height});
  if (window.empty() || window.x0 < 0 || window.y0 < 0 || window.x1 > image.width ||
      window.y1 > image.height)
    throw InputError(fmt::format("the region {},{},{},{} must hold a pixel and lie within the "
                                 "picture of {} x {}",
                                 window.x0, window.y0, window.x1, window.y1, image.width,
                                 image.height));
  return window;
}

void check_range(const std::optional<PassRange>& range) {
  if (range && (range->first < 0 || range->last < range->first))
    throw InputError(fmt::format("the pass range {}-{} must begin at 0 or above and not end before "
                                 "its beginning",
                                 range->first, range->last));
}

} // namespace

RenderResult render(const Scene& scene, const RenderHooks& hooks) {
  validate_scene(scene);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(thread_count(scene.render)));
  return render(scene, prepare_scene(scene), hooks);
}

RenderResult render(const Scene& scene, const PreparedScenePtr& prepared,
                    const RenderHooks& hooks) {
  validate_scene(scene);
  check_range(hooks.pass_range);
  const PixelRegion window = choose_window(scene.image, hooks.region);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(thread_count(scene.render)));
  RenderResult result;
  const auto note = [&](const std::string& line) {
    result.notes.push_back(line);
    if (hooks.on_note)
      hooks.on_note(line);
  };
  const World& world = *prepared->world;
  for (const std::string& line : world.notes)
    note(line);
  result.statistics.read = prepared->seconds_read;
  result.statistics.prepare = prepared->seconds_build;
  const Camera camera(scene.camera, scene.image, world.space);
  result.plan = plan_stages(scene, volume_facts(world, camera));
  result.plan.film_bytes = film_memory(scene.image, window.width(), window.height(), scene.glows());
  check_memory(scene, result.plan, granted_memory());
  for (const std::string& line : limit_notes(scene, world, result.plan))
    note(line);
  // Correlated frames all draw the numbers of frame 1.
  const bool correlated = scene.render.seeds == SeedPolicy::correlated;
  const std::uint64_t key = correlated ? 1 : static_cast<std::uint64_t>(hooks.frame);
  PassLoop loop(scene, hooks, window, result);
  const EstimatorInput input{
      world, camera, result.plan, key, window, &loop.stop_token(), prepared->photons.get()};
  loop.show_quick_look(input);
  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<Estimator> estimator = make_estimator(scene.render.estimator, input);
  std::optional<BiasProbe> probe;
  if (result.plan.needs(Stage::bias))
    probe.emplace(scene, input, window, loop.probe_pixels());
  result.statistics.pilot =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  loop.run(input, *estimator, probe ? &*probe : nullptr);
  return result;
}

} // namespace vdbeam
