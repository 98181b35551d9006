#include "render/pass_loop.h"

#include "film/clamp.h"
#include "film/layers.h"
#include "layers/plane_layers.h"
#include "lights/light_groups.h"
#include "machine/memory.h"
#include "machine/threads.h"
#include "rays/make_deep_layout.h"
#include "render/arithmetic.h"
#include "render/checkpoint.h"
#include "render/error_record.h"
#include "render/limit_notes.h"
#include "render/pass_window.h"
#include "report/image_metadata.h"
#include "report/side_files.h"
#include "scene/shutter.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/metrics.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

namespace vdbeam {
namespace {

constexpr int no_limit = std::numeric_limits<int>::max(); // of passes

} // namespace

PassLoop::PassLoop(const Scene& scene, const FrameSettings& frame, const RenderHooks& hooks,
                   const PixelRegion& window, RenderResult& result)
    : scene_(scene), frame_(frame), hooks_(hooks), window_(window),
      whole_(window.width() == scene.image.raster_width() &&
             window.height() == scene.image.raster_height()),
      result_(result), film_(make_film()), stop_(hooks.stop) {
  if (frame.pass_range)
    first_pass_ = frame.pass_range->first;
  if (!frame.checkpoint.path.empty() || !frame.partial.empty()) {
    pass_hash_ = pass_hash(scene);
    scene_hash_ = scene_hash(scene);
  }
  if (!frame.checkpoint.path.empty() && frame.checkpoint.resume)
    resume();
  set_deadline();
}

/// Makes the film of the window.
Film PassLoop::make_film() const {
  std::optional<DeepFilm> deep;
  if (deep_layout_)
    deep.emplace(window_layout());
  return make_film(window_.width(), window_.height(), std::move(deep));
}

DeepLayout PassLoop::window_layout() const {
  return cut_out(*deep_layout_, scene_.image.raster_width(), window_);
}

Film PassLoop::make_film(int width, int height, std::optional<DeepFilm> deep) const {
  return {width,
          height,
          scene_.glows(),
          light_group_names(scene_),
          std::move(deep),
          scene_.image.cryptomatte ? scene_objects(scene_).names : std::vector<std::string>(),
          plane_names(scene_)};
}

/// By an empty one; two are never there at once.
void PassLoop::replace_film() {
  film_ = Film(1, 1);
  film_ = make_film();
}

void PassLoop::gather_deep(const DeepLayout& layout) {
  deep_layout_ = &layout;
  const bool fits = film_.deep() && film_.deep()->layout().first == layout.first;
  if (film_.passes() == 0)
    replace_film();
  else if (!fits)
    throw FrameError(
        fmt::format("{}: holds other deep samples; delete it", frame_.checkpoint.path));
}

/// Rendering time [s] after which the picture is to be developed and written, for its time counts
/// too; infinite without a limit.
double PassLoop::limit_seconds(Packing packing) const {
  // Processor time [ns] per pixel and channel, measured: to take new memory, develop, make halves
  // and pack them.
  const double per_value = packing == Packing::thorough ? 60 : 15;
  const double values = static_cast<double>(film_.values_per_pixel()) * window_.width() *
                        static_cast<double>(window_.height());
  return scene_.render.time && !frame_.pass_range
             ? *scene_.render.time - frame_.seconds_used -
                   1e-9 * per_value * values / thread_count(scene_.render)
             : std::numeric_limits<double>::infinity();
}

void PassLoop::set_deadline(Packing packing) {
  stop_.set_deadline(start_, limit_seconds(packing) - earlier_seconds_);
}

double PassLoop::seconds() const {
  return earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count();
}

void PassLoop::note(const std::string& line) {
  result_.notes.push_back(line);
  if (hooks_.on_note)
    hooks_.on_note(line);
}

void PassLoop::begin_step(RenderStep step) const {
  const bool of_pass = step == RenderStep::photons || step == RenderStep::pass;
  if (hooks_.on_step)
    hooks_.on_step(step, of_pass ? next_pass() + 1 : 0);
}

void PassLoop::run(Shutter& shutter, const EstimatorInput& quick_look) {
  since_attempt_.restart();
  while (!finished())
    render_pass(shutter);
  if (hooks_.discards_when_stopped && result_.stopped_by == "stop")
    return;
  begin_step(RenderStep::develop);
  if (result_.stopped_by == "stop")
    write_checkpoint();
  else if (!frame_.partial.empty())
    write_film(file_info(), film_, frame_.partial);
  if (film_.passes() == 0) {
    take_early_picture(quick_look);
  } else {
    develop();
  }
  const int times = shutter_times(scene_.camera);
  if (!scene_.moments.empty() && !frame_.pass_range && film_.passes() > 0 && film_.passes() < times)
    note(fmt::format(
        "motion blur has {} only, one per pass, and may show steps; render at least {} passes",
        count_text(static_cast<std::uint64_t>(film_.passes()), "motion sample"), times));
  if (const auto starved = starved_note(scene_, result_.plan, result_.statistics))
    note(*starved);
  if (film_.invalid_values() > 0)
    note(fmt::format("{} pixel values were not finite and count as 0", film_.invalid_values()));
  if (scene_.render.clamp)
    note(fmt::format("render.clamp = {:g} removed {:.3g} % of the image's light, from {} pixels of "
                     "passes; the estimated error does not include it",
                     *scene_.render.clamp, 100 * result_.statistics.clamped_fraction(),
                     result_.statistics.clamped_pixels));
}

/// The renderer of the next pass; null if its motion sample was being prepared when the frame was
/// to end.
std::optional<Shutter::Renderer> PassLoop::renderer_of_pass(Shutter& shutter) {
  try {
    return shutter.at(next_pass(), result_.statistics);
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

/// Adds the next pass to the film, or nothing where it was stopped.
void PassLoop::render_pass(Shutter& shutter) {
  const Stopwatch watch;
  const std::optional<Shutter::Renderer> renderer = renderer_of_pass(shutter);
  if (!renderer)
    return;
  const auto& [passes, probe] = *renderer;
  passes.render_pass(next_pass(), image_, result_.statistics);
  if (stop_.requested() || !is_finished(image_, window_))
    return;
  std::vector<PixelValue> probes;
  if (probe)
    probes = probe->trace(passes.specify(next_pass()), result_.statistics);
  if (stop_.requested())
    return;
  if (stop_.stopped()) // the picture needs no probes, and it is finished
    probes.clear();
  if (!whole_)
    image_ = cut_out(image_, window_);
  clamp(image_);
  film_.add(image_, probes);
  const double took = watch.seconds();
  shortest_pass_ = shortest_pass_ > 0 ? std::min(shortest_pass_, took) : took;
  record();
  serve_requests();
}

void PassLoop::clamp(PassImage& pass) {
  if (!scene_.render.clamp)
    return;
  const ClampTally tally = clamp_pass(pass, *scene_.render.clamp);
  result_.statistics.clamp_removed += tally.removed;
  result_.statistics.clamp_total += tally.total;
  result_.statistics.clamped_pixels += tally.pixels;
}

bool PassLoop::finished() {
  const int passes = film_.passes();
  if (stop_.requested())
    return stop("stop");
  const RenderSettings& settings = scene_.render;
  if (frame_.pass_range)
    return next_pass() > frame_.pass_range->last && stop("passes");
  if (settings.passes && passes >= *settings.passes)
    return stop("passes");
  if (time_is_over())
    return stop("time");
  if (settings.target_error && passes >= least_passes() &&
      estimate_errors().error_estimate <= *settings.target_error)
    return stop("target_error");
  return false;
}

/// Passes before the estimated error may end the frame.
int PassLoop::least_passes() const {
  // The spread of fewer passes says little, and blur by fewer moments shows as steps.
  constexpr int trusted_passes = 4;
  const int moments = scene_.moments.empty() ? 0 : shutter_times(scene_.camera);
  return scene_.render.min_passes.value_or(std::max(trusted_passes, moments));
}

/// Also where a pass more would not be finished in time.
bool PassLoop::time_is_over() const {
  constexpr double likely_least = 0.8; // of the shortest pass so far
  return stop_.time_is_over() || seconds() + likely_least * shortest_pass_ > limit_seconds();
}

bool PassLoop::stop(const char* reason) {
  result_.stopped_by = reason;
  return true;
}

PassRange PassLoop::passes_asked_for() const {
  return frame_.pass_range.value_or(PassRange{0, scene_.render.passes.value_or(no_limit) - 1});
}

/// Takes the film of the checkpoint if it is of this scene and holds this render's first passes. A
/// file that is not is left where it is until the next checkpoint replaces it.
void PassLoop::resume() {
  const std::string& path = frame_.checkpoint.path;
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    return;
  try {
    const FilmFileInfo info = read_film_info(path);
    if (const std::string reason = why_not_resumable(info, file_info(), passes_asked_for());
        !reason.empty())
      return note(fmt::format("{}: {}; the frame starts over", path, reason));
    film_ = read_film(path, info);
    earlier_seconds_ = info.seconds;
    const auto number = [&](const char* name) {
      const auto found = info.header.numbers.find(name);
      return found == info.header.numbers.end() || std::isnan(found->second) ? 0.0 : found->second;
    };
    photons_before_ = result_.statistics.photons_stored =
        static_cast<std::uint64_t>(std::clamp(number("vdbeam:photonsStored"), 0.0, 1e18));
    result_.statistics.clamp_removed = number("vdbeam:clampRemoved");
    result_.statistics.clamp_total = number("vdbeam:clampTotal");
    result_.statistics.clamped_pixels =
        static_cast<std::uint64_t>(std::clamp(number("vdbeam:clampedPixels"), 0.0, 1e18));
  } catch (const InputError& problem) {
    return note(fmt::format("{}; the frame starts over", problem.what()));
  }
  result_.resumed_passes = last_checkpoint_passes_ = last_attempt_passes_ = film_.passes();
  note(fmt::format("{}: resumes after {}", path,
                   count_text(static_cast<std::size_t>(film_.passes()), "pass")));
  PassRecord record = estimate_errors();
  record.seconds = earlier_seconds_;
  result_.passes.push_back(record);
}

PassRecord PassLoop::estimate_errors() const {
  return error_record(film_, result_.plan.unbiased);
}

void PassLoop::record() {
  PassRecord record = estimate_errors();
  record.seconds = seconds();
  record.photons = result_.statistics.photons_stored - photons_before_;
  photons_before_ = result_.statistics.photons_stored;
  if (frame_.reference)
    compare(record);
  result_.passes.push_back(record);
  result_.statistics.peak_memory = peak_memory();
  if (hooks_.on_pass)
    hooks_.on_pass(record, result_.statistics);
}

void PassLoop::compare(PassRecord& record) {
  const Image image = film_.develop();
  const ImageError error = frame_.second_reference
                               ? image_error(image, *frame_.reference, *frame_.second_reference)
                               : image_error(image, *frame_.reference);
  record.has_reference = true;
  record.rmse = error.rmse;
  record.mrse = error.mrse;
  record.relmse = error.relmse;
  record.bias = error.bias;
  // Comparing is not rendering.
  start_ += std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(seconds() - record.seconds));
  set_deadline();
}

void PassLoop::serve_requests() {
  take_snapshot();
  const CheckpointSettings& settings = frame_.checkpoint;
  if ((settings.seconds > 0 && since_attempt_.seconds() >= settings.seconds) ||
      (settings.passes > 0 && film_.passes() - last_attempt_passes_ >= settings.passes)) {
    attempt([&] { write_checkpoint(); });
    since_attempt_.restart();
    last_attempt_passes_ = film_.passes();
  }
}

/// Writes a file that the picture does not need: a full disk must not cost the passes so far.
void PassLoop::attempt(const std::function<void()>& write) {
  try {
    write();
  } catch (const FrameError& error) {
    note(fmt::format("{}; rendering continues", error.what()));
  }
}

void PassLoop::write_checkpoint() {
  if (frame_.checkpoint.path.empty() || film_.passes() == last_checkpoint_passes_)
    return;
  const std::string& path = frame_.checkpoint.path;
  if (const std::string why = why_not_replaceable(path, Output::checkpoint); !why.empty())
    throw FrameError(why + ", and is left unchanged");
  write_film(file_info(), film_, path, Links::replace);
  last_checkpoint_passes_ = film_.passes();
}

void PassLoop::develop() {
  result_.image = develop_layers(film_, scene_.layers);
  result_.deep = film_.develop_deep();
  finish_image();
}

/// Says what the colours are, and where the pixels lie.
void PassLoop::finish_image() {
  result_.image.primaries = chromaticities_of(scene_.image.working_space);
  if (!whole_ || scene_.image.overscan > 0)
    place(result_.image);
}

/// Says where the pixels lie in the picture.
void PassLoop::place(Image& image) const {
  image.x = window_.x0 - scene_.image.overscan;
  image.y = window_.y0 - scene_.image.overscan;
  image.full_width = scene_.image.width;
  image.full_height = scene_.image.height;
}

FilmFileInfo PassLoop::file_info() const {
  FilmFileInfo info;
  info.header.primaries = chromaticities_of(scene_.image.working_space);
  info.arithmetic = arithmetic_fingerprint();
  info.header.width = window_.width();
  info.header.height = window_.height();
  place(info.header);
  add_image_metadata(info.header, scene_, result_, scene_hash_);
  info.pass_hash = pass_hash_;
  info.frame = scene_.frame.number;
  info.passes.resize(static_cast<std::size_t>(film_.passes()));
  std::iota(info.passes.begin(), info.passes.end(), first_pass_);
  info.invalid_values = film_.invalid_values();
  info.seconds = seconds();
  info.unbiased = result_.plan.unbiased;
  return info;
}

} // namespace vdbeam
