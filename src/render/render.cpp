#include "vdbeam/render.h"

#include "choose/choose_estimator.h"
#include "choose/feature.h"
#include "film/deep_film.h"
#include "layers/plane_layers.h"
#include "machine/memory.h"
#include "machine/stopwatch.h"
#include "machine/threads.h"
#include "plan/memory_check.h"
#include "prepare/prepared_scene.h"
#include "rays/make_deep_layout.h"
#include "render/frame_setup.h"
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
    throw InputError(fmt::format(
        "the region {},{},{},{} must contain a pixel and lie within the image of {} x {}{}",
        window.x0, window.y0, window.x1, window.y1, image.width, image.height,
        o > 0 ? " and its overscan" : ""));
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
  const auto begin = StopToken::Clock::now();
  const bool limited = scene.render.time && !frame.pass_range;
  StopToken stop(hooks.stop);
  if (limited)
    stop.set_deadline(begin, preparation_limit(scene.render));
  PreparedScenePtr prepared;
  try {
    prepared = prepare_scene(scene, nullptr, stop);
  } catch (const Stopped&) {
    if (limited && !stop.requested())
      throw preparation_failure(scene.path, scene.render);
    throw FrameError(scene.path + ": was stopped while its files were read and prepared");
  }
  FrameSettings rest = frame;
  rest.seconds_used += std::chrono::duration<double>(StopToken::Clock::now() - begin).count();
  return render(scene, prepared, rest, hooks);
}

namespace {

/// Cuts the rays of a deep picture. An empty layout means that there was no time for it, and none
/// is left for passes.
void cut_deep_rays(const Scene& scene, FrameSetup& setup, PassLoop& loop, DeepLayout& deep) {
  if (!scene.image.deep)
    return;
  const std::uint64_t granted = granted_memory();
  deep = make_deep_layout(setup.input, scene.image.deep_alpha,
                          deep_depth(scene.image, setup.world()), [&](std::size_t pieces) {
                            check_deep_memory(scene, pieces * DeepFilm::bytes_per_piece(), granted);
                          });
  if (deep.first.empty())
    return;
  loop.gather_deep(deep);
  setup.input.deep = &deep;
}

/// The estimator that renders: the one that the scene names, or what `auto` takes.
EstimatorChoice choose_for_frame(const Scene& scene, const FrameSetup& setup, RenderPlan& plan,
                                 RenderStatistics& statistics) {
  plan = setup.plan;
  if (scene.render.estimator != EstimatorType::automatic)
    return {scene.render.estimator, {}, 0, nullptr};
  const Stopwatch watch;
  EstimatorChoice choice = choose_estimator(setup.input, setup.path_input());
  statistics.pilot += watch.seconds();
  if (choice.type == EstimatorType::path)
    plan = setup.path_plan;
  plan.estimator = choice.type.name;
  plan.choice = choice.reason;
  return choice;
}

/// Why a feature is on or off in the plan.
std::string reason_of(const Feature& feature, const RenderPlan& plan) {
  for (const FeatureChoice& choice : plan.features)
    if (choice.name == feature.name)
      return choice.reason;
  return {};
}

/// The type whose passes are rendered: `auto` where photons are gathered in more than one way.
EstimatorType type_of_passes(const Scene& scene, const EstimatorChoice& choice) {
  return choice.type == EstimatorType::path ? choice.type : scene.render.estimator;
}

/// Takes notes for the user: in the result, and to whoever hears them.
struct Notes {
  RenderResult& result;
  const RenderHooks& hooks;

  void add(const std::string& line) const {
    result.notes.push_back(line);
    if (hooks.on_note)
      hooks.on_note(line);
  }
  void add(const std::vector<std::string>& lines) const {
    for (const std::string& line : lines)
      add(line);
  }
};

/// Makes the choices of the first pass, whose pilot does not count as part of it, and describes
/// them in the plan of the result.
void describe_first_pass(const EstimatorInput& input, EstimatorType type, const PassRenderer& first,
                         const Notes& notes) {
  RenderPlan& plan = notes.result.plan;
  describe_choices(input, type, first.choices(), plan);
  if (type == EstimatorType::gather && !first.choices().gather)
    notes.add("render.estimator = \"gather\" gathers along camera rays here: " +
              reason_of(final_gather_feature, plan));
}

/// Describes the finished image.
void describe_image(const Scene& scene, const Sight& sight, const Notes& notes) {
  notes.result.picture = picture_facts(notes.result.image, sight);
  if (!scene.lights.empty() || scene.glows()) // the scene's own note says that there is no light
    notes.add(picture_notes(notes.result.picture));
}

} // namespace

RenderPlan choose_plan(const Scene& scene) {
  validate_scene(scene);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(thread_count(scene.render)));
  const PreparedScenePtr prepared = prepare_scene(scene);
  const FrameSetup setup(scene, prepared, choose_window(scene.image, std::nullopt));
  RenderPlan plan;
  RenderStatistics statistics;
  const EstimatorChoice choice = choose_for_frame(scene, setup, plan, statistics);
  const bool path = choice.type == EstimatorType::path;
  const EstimatorInput input = path ? setup.path_input() : setup.input;
  const EstimatorType type = type_of_passes(scene, choice);
  if (choice.photons)
    describe_choices(input, type, choice.photons->choices(), plan);
  else
    describe_choices(input, type, choose_for_scene(input, estimator_kind(type)).choices, plan);
  return plan;
}

RenderResult render(const Scene& scene, const PreparedScenePtr& prepared,
                    const FrameSettings& frame, const RenderHooks& hooks) {
  validate_scene(scene);
  check_range(frame.pass_range);
  const PixelRegion window = choose_window(scene.image, frame.region);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(thread_count(scene.render)));
  RenderResult result;
  const Notes notes{result, hooks};
  notes.add(prepared->facts.notes);
  add_work(result.statistics, *prepared);
  if (hooks.on_step)
    hooks.on_step(RenderStep::prepare, 0);
  FrameSetup setup(scene, prepared, window);
  result.plan = setup.plan;
  check_memory(scene, setup.plan, granted_memory());
  PassLoop loop(scene, frame, hooks, window, result);
  setup.input.stop = &loop.stop_token();
  const std::function<void(RenderStep)> on_step = [&](RenderStep step) { loop.begin_step(step); };
  setup.input.on_step = &on_step;
  setup.probe_blur(loop.probe_pixels());
  DeepLayout deep;
  cut_deep_rays(scene, setup, loop, deep);
  const EstimatorInput path_input = setup.path_input();
  if (loop.draft(prepared, setup.input))
    return result;
  loop.show_quick_look(path_input);
  loop.begin_step(RenderStep::pilot);
  EstimatorChoice choice = choose_for_frame(scene, setup, result.plan, result.statistics);
  const bool path = choice.type == EstimatorType::path;
  if (path && !choice.reason.empty())
    notes.add(fmt::format("render.estimator = \"auto\" takes path: {}", choice.reason));
  const EstimatorInput& input = path ? path_input : setup.input;
  const EstimatorType type = type_of_passes(scene, choice);
  Shutter shutter(scene, type, prepared, input, setup.path_plan, loop.probe_pixels());
  if (choice.photons) {
    if (scene.moments.empty())
      shutter.take(std::move(choice.photons));
    else
      shutter.follow({choice.photons->choices(), setup.world().space}, result.statistics);
  }
  notes.add(limit_notes(scene, input));
  const Sight sight = look_through(setup.world(), setup.camera, window);
  notes.add(sight_notes(scene, setup.world(), setup.camera, sight));
  try {
    describe_first_pass(input, type, shutter.at(loop.next_pass(), result.statistics).passes, notes);
  } catch (const Stopped&) { // the loop finds out why
  }
  loop.run(shutter, path_input);
  if (result.quick_look || result.draft > 0 || frame.pass_range || result.image.channels.empty())
    return result;
  describe_image(scene, sight, notes);
  return result;
}

} // namespace vdbeam
