#include "render/pass_loop.h"

#include "film/clamp.h"
#include "render/arithmetic.h"
#include "render/error_record.h"
#include "report/image_metadata.h"
#include "vdbeam/error.h"
#include "vdbeam/metrics.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace vdbeam {
namespace {

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// The part of a pass that lies in the window.
PassImage cut_out(const PassImage& pass, const PixelWindow& window) {
  PassImage part;
  part.resize(window.width(), window.height(), !pass.emission.empty());
  for (int y = 0; y < window.height(); ++y) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(window.y0 + y) * pass.width + window.x0;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(y) * part.width;
    const auto copy = [&](const auto& source, auto& target) {
      std::copy_n(source.begin() + from, part.width, target.begin() + to);
    };
    copy(pass.direct, part.direct);
    copy(pass.indirect, part.indirect);
    copy(pass.background, part.background);
    if (!pass.emission.empty())
      copy(pass.emission, part.emission);
    copy(pass.opacity, part.opacity);
    copy(pass.depth, part.depth);
  }
  return part;
}

} // namespace

PassLoop::PassLoop(const Scene& scene, const RenderHooks& hooks, const PixelWindow& window,
                   RenderResult& result)
    : scene_(scene), hooks_(hooks), window_(window),
      whole_(window.width() == scene.image.width && window.height() == scene.image.height),
      result_(result), film_(window.width(), window.height(), scene.glows()) {
  if (hooks.pass_range)
    first_pass_ = hooks.pass_range->first;
  if (!hooks.checkpoint.path.empty() || !hooks.partial.empty())
    pass_hash_ = pass_hash(scene);
}

double PassLoop::seconds() const {
  return earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count();
}

void PassLoop::note(const std::string& line) {
  result_.notes.push_back(line);
  if (hooks_.on_note)
    hooks_.on_note(line);
}

void PassLoop::run(Estimator& estimator, BiasProbe* probe) {
  if (!hooks_.checkpoint.path.empty() && hooks_.checkpoint.resume)
    resume();
  last_attempt_ = Clock::now();
  PassImage image;
  while (!finished()) {
    estimator.render_pass(next_pass(), image, result_.statistics);
    if (stop_requested())
      continue; // the pass was abandoned
    std::vector<ProbeValue> probes;
    if (probe)
      probes = probe->trace(next_pass(), result_.statistics);
    if (stop_requested())
      continue;
    if (!whole_)
      image = cut_out(image, window_);
    clamp(image);
    film_.add(image, probes);
    record();
    serve_requests();
  }
  if (result_.stopped_by == "stop")
    write_checkpoint();
  else if (!hooks_.partial.empty())
    write_film(file_info(), film_, hooks_.partial);
  develop();
  if (film_.invalid_values() > 0)
    note(fmt::format("{} pixel values were not finite and count as 0", film_.invalid_values()));
  if (scene_.render.clamp)
    note(fmt::format("render.clamp = {:g} took {:.3g} % of the picture's light, from {} pixels of "
                     "passes; the estimated error does not hold it",
                     *scene_.render.clamp, 100 * result_.statistics.clamped_fraction(),
                     result_.statistics.clamped_pixels));
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
  if (stop_requested())
    return stop("stop");
  const RenderSettings& settings = scene_.render;
  if (hooks_.pass_range)
    return next_pass() > hooks_.pass_range->last && stop("passes");
  if (settings.passes && passes >= *settings.passes)
    return stop("passes");
  if (passes > 0 && settings.time && seconds() >= *settings.time)
    return stop("time");
  // Fewer passes than this do not tell their own spread.
  constexpr int trusted_passes = 4;
  if (settings.target_error && passes >= trusted_passes &&
      estimate_errors().error_estimate <= *settings.target_error)
    return stop("target_error");
  return false;
}

bool PassLoop::stop(const char* reason) {
  result_.stopped_by = reason;
  return true;
}

/// Takes the film of the checkpoint if it is of this scene and holds this render's first passes. A
/// file that is not is left where it is until the next checkpoint replaces it.
void PassLoop::resume() {
  const std::string& path = hooks_.checkpoint.path;
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    return;
  try {
    const FilmFileInfo info = read_film_info(path);
    if (info.arithmetic != arithmetic_fingerprint())
      return note(path + ": is a checkpoint of a machine that rounds differently (one of the two "
                         "lacks fused multiply-add or has another C library); the frame begins "
                         "anew");
    std::vector<int> expected(info.passes.size());
    std::iota(expected.begin(), expected.end(), first_pass_);
    const bool fits = info.joins(file_info()) && info.passes == expected &&
                      (!hooks_.pass_range || info.passes.back() <= hooks_.pass_range->last) &&
                      (!scene_.render.passes || hooks_.pass_range ||
                       static_cast<int>(info.passes.size()) <= *scene_.render.passes);
    if (!fits)
      return note(path + ": is a checkpoint of another scene, frame, size or pass range; the frame "
                         "begins anew");
    film_ = read_film(path, info);
    earlier_seconds_ = info.seconds;
    const auto number = [&](const char* name) {
      const auto found = info.header.numbers.find(name);
      return found == info.header.numbers.end() || std::isnan(found->second) ? 0.0 : found->second;
    };
    result_.statistics.clamp_removed = number("vdbeam:clampRemoved");
    result_.statistics.clamp_total = number("vdbeam:clampTotal");
    result_.statistics.clamped_pixels =
        static_cast<std::uint64_t>(std::clamp(number("vdbeam:clampedPixels"), 0.0, 1e18));
  } catch (const InputError& problem) {
    return note(fmt::format("{}; the frame begins anew", problem.what()));
  }
  result_.resumed_passes = last_checkpoint_passes_ = last_attempt_passes_ = film_.passes();
  note(fmt::format("{}: goes on after {} passes", path, film_.passes()));
  PassRecord record = estimate_errors();
  record.seconds = earlier_seconds_;
  result_.passes.push_back(record);
}

PassRecord PassLoop::estimate_errors() const {
  const bool unbiased = !scene_.render.clamp && (scene_.render.estimator == EstimatorType::path ||
                                                 !result_.plan.needs("photons"));
  return error_record(film_, unbiased);
}

void PassLoop::record() {
  PassRecord record = estimate_errors();
  record.seconds = seconds();
  record.photons = result_.statistics.photons_stored - photons_before_;
  photons_before_ = result_.statistics.photons_stored;
  if (hooks_.reference)
    compare(record);
  result_.passes.push_back(record);
  result_.statistics.peak_memory = peak_memory();
  if (hooks_.on_pass)
    hooks_.on_pass(record, result_.statistics);
}

void PassLoop::compare(PassRecord& record) {
  const ImageError error = image_error(film_.develop(), *hooks_.reference);
  record.has_reference = true;
  record.rmse = error.rmse;
  record.mrse = error.mrse;
  record.relmse = error.relmse;
  record.bias = error.bias;
  // Comparing is not rendering.
  start_ += std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(seconds() - record.seconds));
}

void PassLoop::serve_requests() {
  if (hooks_.snapshot && hooks_.snapshot->exchange(false) && hooks_.on_snapshot) {
    develop();
    attempt([&] { hooks_.on_snapshot(result_); });
  }
  const CheckpointSettings& settings = hooks_.checkpoint;
  const double since = std::chrono::duration<double>(Clock::now() - last_attempt_).count();
  if ((settings.seconds > 0 && since >= settings.seconds) ||
      (settings.passes > 0 && film_.passes() - last_attempt_passes_ >= settings.passes)) {
    attempt([&] { write_checkpoint(); });
    last_attempt_ = Clock::now();
    last_attempt_passes_ = film_.passes();
  }
}

/// Writes a file that the picture does not need: a full disk must not cost the passes so far.
template <class F>
void PassLoop::attempt(F write) {
  try {
    write();
  } catch (const FrameError& error) {
    note(fmt::format("{}; rendering goes on", error.what()));
  }
}

void PassLoop::write_checkpoint() {
  if (hooks_.checkpoint.path.empty() || film_.passes() == last_checkpoint_passes_)
    return;
  write_film(file_info(), film_, hooks_.checkpoint.path);
  last_checkpoint_passes_ = film_.passes();
}

void PassLoop::develop() {
  result_.image = film_.develop();
  if (whole_)
    return;
  result_.image.x = window_.x0;
  result_.image.y = window_.y0;
  result_.image.full_width = scene_.image.width;
  result_.image.full_height = scene_.image.height;
}

FilmFileInfo PassLoop::file_info() const {
  FilmFileInfo info;
  info.arithmetic = arithmetic_fingerprint();
  info.header.width = window_.width();
  info.header.height = window_.height();
  info.header.x = window_.x0;
  info.header.y = window_.y0;
  info.header.full_width = scene_.image.width;
  info.header.full_height = scene_.image.height;
  add_image_metadata(info.header, scene_, result_, hooks_.frame, scene_hash(scene_));
  info.pass_hash = pass_hash_;
  info.frame = hooks_.frame;
  info.passes.resize(static_cast<std::size_t>(film_.passes()));
  std::iota(info.passes.begin(), info.passes.end(), first_pass_);
  info.invalid_values = film_.invalid_values();
  info.seconds = seconds();
  return info;
}

} // namespace vdbeam
