#include "vdbeam/render.h"

#include "estimators/estimator.h"
#include "film/film.h"
#include "render/plan.h"
#include "vdbeam/metrics.h"
#include "vdbeam/scene_file.h"

#include <sys/resource.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>

namespace vdbeam {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// The frame's passes, from the first to whatever ends it.
class PassLoop {
public:
  PassLoop(const Scene& scene, const RenderHooks& hooks, RenderResult& result)
      : settings_(scene.render), hooks_(hooks), result_(result),
        film_(scene.image.width, scene.image.height) {}

  void run(Estimator& estimator) {
    start_ = Clock::now();
    PassImage image;
    for (int pass = 0; !finished(pass); ++pass) {
      estimator.render_pass(pass, image, result_.statistics);
      film_.add(image);
      record(pass);
    }
    result_.image = film_.develop();
    if (film_.invalid_values() > 0)
      result_.notes.push_back(std::to_string(film_.invalid_values()) +
                              " pixel values were not finite and count as 0");
  }

private:
  bool finished(int passes) {
    if (hooks_.stop && *hooks_.stop && passes > 0)
      return stop("stop");
    if (settings_.passes && passes >= *settings_.passes)
      return stop("passes");
    if (passes > 0 && settings_.time && seconds_since(start_) >= *settings_.time)
      return stop("time");
    // Fewer passes than this do not tell their own spread.
    constexpr int trusted_passes = 4;
    if (settings_.target_error && passes >= trusted_passes &&
        result_.passes.back().error_estimate <= *settings_.target_error)
      return stop("target_error");
    return false;
  }
  bool stop(const char* reason) {
    result_.stopped_by = reason;
    return true;
  }

  void record(int pass) {
    PassRecord record;
    record.pass = pass + 1;
    record.seconds = seconds_since(start_);
    record.photons = result_.statistics.photons_stored - photons_before_;
    photons_before_ = result_.statistics.photons_stored;
    record.error_estimate = film_.mrse_estimate();
    if (hooks_.reference) {
      const ImageError error = image_error(film_.develop(), *hooks_.reference);
      record.has_reference = true;
      record.rmse = error.rmse;
      record.mrse = error.mrse;
      record.relmse = error.relmse;
      record.bias = error.bias;
      // Comparing is not rendering.
      start_ += std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(seconds_since(start_) - record.seconds));
    }
    result_.passes.push_back(record);
    result_.statistics.peak_memory = peak_memory();
    if (hooks_.on_pass)
      hooks_.on_pass(record, result_.statistics);
  }

  const RenderSettings& settings_;
  const RenderHooks& hooks_;
  RenderResult& result_;
  Film film_;
  Clock::time_point start_;
  std::uint64_t photons_before_ = 0;
};

void note(RenderResult& result, const RenderHooks& hooks, const std::string& line) {
  result.notes.push_back(line);
  if (hooks.on_note)
    hooks.on_note(line);
}

} // namespace

RenderResult render(const Scene& scene, const RenderHooks& hooks) {
  validate_scene(scene);
  const int threads =
      scene.render.threads > 0 ? scene.render.threads : tbb::info::default_concurrency();
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(threads));
  RenderResult result;
  const World world = build_world(scene);
  for (const std::string& line : world.notes)
    note(result, hooks, line);
  result.statistics.read = world.seconds_read;
  std::vector<VolumeFacts> facts;
  for (const std::uint64_t voxels : world.active_voxels)
    facts.push_back({voxels == 0, voxels});
  result.plan = plan_stages(scene, facts);
  const Camera camera(scene.camera, scene.image, world.space);
  const EstimatorInput input{world, camera, static_cast<std::uint64_t>(hooks.frame)};
  const std::unique_ptr<Estimator> estimator = make_estimator(scene.render.estimator, input);
  PassLoop(scene, hooks, result).run(*estimator);
  return result;
}

} // namespace vdbeam
