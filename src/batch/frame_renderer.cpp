#include "batch/frame_renderer.h"

#include "batch/frame_events.h"
#include "batch/frame_texts.h"
#include "batch/output_paths.h"
#include "batch/reference_image.h"
#include "console/progress.h"
#include "console/signals.h"
#include "film/film_file.h"
#include "image/color_conversion.h"
#include "image/deep_check.h"
#include "image/output_formats.h"
#include "machine/stopwatch.h"
#include "machine/temporary_files.h"
#include "report/image_metadata.h"
#include "report/report.h"
#include "report/side_files.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/scene_file.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

namespace vdbeam::cli {
namespace {

/// Bars and time left are about the passes that are asked for.
RenderSettings progress_settings(const Scene& scene, const std::optional<PassRange>& range) {
  RenderSettings settings = scene.render;
  if (range) {
    settings.passes = range->last - range->first + 1;
    settings.time.reset();
    settings.target_error.reset();
  }
  return settings;
}

/// What is known of the error of the image.
void add_error(FrameOutcome& outcome, const RenderResult& result) {
  if (result.passes.empty())
    return;
  const auto known = [](double value) {
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  };
  const PassRecord& last = result.passes.back();
  outcome.error = known(last.error_estimate);
  outcome.error_low = known(last.error_low);
  outcome.error_high = known(last.error_high);
}

} // namespace

std::string FrameRenderer::path(Output output, int frame) const {
  return output_path(options_.files, output, frame);
}

void FrameRenderer::check_side_files(int frame) const {
  // A snapshot can be done without, and whatever has its name is left alone then.
  const std::string why = why_not_replaceable(path(Output::checkpoint, frame), Output::checkpoint);
  if (!why.empty())
    throw InputError(
        fmt::format("{}, but -o {} needs its name; rename it, or the output", why, output(frame)));
}

void FrameRenderer::remove_side_files(int frame) const {
  for (const Output kind : {Output::checkpoint, Output::snapshot})
    remove_side_file(path(kind, frame), kind);
  std::error_code ignored; // one that stays does no harm
  for (const std::string& pattern : options_.parts)
    if (const std::string part = substitute_frame(pattern, frame); holds_film(part))
      std::filesystem::remove(part, ignored);
}

void FrameRenderer::remove_dead_files(int frame) const {
  for (const OutputKind& kind : output_kinds())
    if (const std::string file = path(kind.output, frame); !file.empty() && !is_stdout(file))
      remove_dead_temporaries(std::filesystem::path(file).parent_path().string());
}

std::string FrameRenderer::region_text() const {
  const auto& r = options_.region;
  return r ? fmt::format("{},{},{},{}", r->x0, r->y0, r->x1, r->y1) : "";
}

void FrameRenderer::add_metadata(Image& image, const LoadedFrame& loaded,
                                 const RenderResult& result) const {
  add_image_metadata(image, loaded.scene, result, loaded.hash);
  if (options_.region)
    image.metadata["vdbeam:region"] = region_text();
}

std::string FrameRenderer::why_no_part(const std::string& path, const LoadedFrame& loaded) const {
  const FilmFileInfo info = read_film_info(path);
  const PassRange range = *options_.pass_range;
  std::vector<int> wanted(static_cast<std::size_t>(range.last - range.first + 1));
  std::iota(wanted.begin(), wanted.end(), range.first);
  if (info.pass_hash != pass_hash(loaded.scene) || info.frame != loaded.frame() ||
      info.passes != wanted)
    return "is of another scene, frame or pass range";
  const ImageSettings& size = loaded.scene.image;
  if (info.header.full_width != size.width || info.header.full_height != size.height ||
      info.header.width > size.raster_width() || info.header.height > size.raster_height())
    return "has another size";
  read_film(path, info); // all of it: the header does not reveal a truncated file
  return "";
}

std::string FrameRenderer::why_no_image(const std::string& path, const LoadedFrame& loaded) const {
  const Image image = read_image(path);
  const auto text = [&](const char* name) {
    const auto found = image.metadata.find(name);
    return found == image.metadata.end() ? std::string() : found->second;
  };
  const auto marker = image.numbers.find("vdbeam:complete");
  if (image.width != loaded.scene.image.width || image.height != loaded.scene.image.height)
    return "has another size";
  if (marker == image.numbers.end() || marker->second != 1)
    return "is not marked as finished";
  if (text("vdbeam:sceneHash") != loaded.hash || text("vdbeam:region") != region_text())
    return "is of another scene";
  const auto frame = image.numbers.find("vdbeam:frame");
  if (frame == image.numbers.end() || frame->second != loaded.frame())
    return "is of another frame";
  if (loaded.scene.image.deep)
    check_deep_exr(output_path({.output = path}, Output::deep, loaded.frame()));
  return "";
}

std::string FrameRenderer::why_unfinished(const LoadedFrame& loaded) const {
  const auto why = [](const std::string& path, const auto& judge) -> std::string {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
      return "is not there";
    try {
      return judge(path);
    } catch (const InputError& problem) {
      return problem.what();
    }
  };
  const auto image = [&](const std::string& path) { return why_no_image(path, loaded); };
  const auto part = [&](const std::string& path) { return why_no_part(path, loaded); };
  if (!options_.pass_range)
    return why(output(loaded.frame()), image);
  if (!options_.merged.empty() &&
      why(substitute_frame(options_.merged, loaded.frame()), image).empty())
    return "";
  const std::string reason = why(output(loaded.frame()), part);
  const std::string report = path(Output::report, loaded.frame());
  std::error_code error;
  // A part is written before its report, which a kill may have kept from being written.
  if (reason.empty() && !report.empty() && !is_stdout(report) &&
      !std::filesystem::exists(report, error))
    return "has no report";
  return reason;
}

void FrameRenderer::join_parts(const LoadedFrame& loaded) const {
  const std::string hash = pass_hash(loaded.scene);
  std::vector<std::string> paths;
  for (const std::string& pattern : options_.parts) {
    const std::string path = substitute_frame(pattern, loaded.frame());
    const FilmFileInfo info = read_film_info(path);
    if (info.pass_hash != hash || info.frame != loaded.frame())
      throw FrameError(path + ": shows another frame, another scene, or volumes that have changed "
                              "since; render its passes again");
    paths.push_back(path);
  }
  MergeSettings settings;
  settings.passes = loaded.scene.render.passes;
  settings.deep = path(Output::deep, loaded.frame());
  Image image = merge_partials(paths, settings);
  image.metadata["vdbeam:sceneHash"] = loaded.hash; // the parts' may have another number of passes
  if (options_.region)
    image.metadata["vdbeam:region"] = region_text();
  if (!options_.files.preview.empty())
    write_image(image, path(Output::preview, loaded.frame()), {options_.exposure, options_.view});
  write_image(image, output(loaded.frame()), {options_.exposure, options_.view});
  remove_side_files(loaded.frame());
}

void FrameRenderer::write_preview(const RenderResult& result, int frame) const {
  const std::string file = path(Output::preview, frame);
  if (file.empty())
    return;
  write_image(result.image, file, {options_.exposure, options_.view});
  send_file(Output::preview, file, frame, result);
}

void FrameRenderer::write_snapshot(const RenderResult& result, int frame) const {
  const std::string file = path(Output::snapshot, frame);
  if (const std::string why = why_not_replaceable(file, Output::snapshot); !why.empty())
    throw FrameError(why + ", and is left unchanged");
  write_image(result.image, file, {.links = Links::replace});
  send_file(Output::snapshot, file, frame, result);
}

/// Writes what there is so far for those who wait for it at intervals, or asked for it now.
void FrameRenderer::write_so_far(const LoadedFrame& loaded, RenderResult& so_far,
                                 bool asked) const {
  const bool at_intervals = options_.snapshot.wanted();
  if (at_intervals || (so_far.quick_look && options_.early_preview))
    write_preview(so_far, loaded.frame());
  if (!at_intervals && !asked)
    return;
  add_metadata(so_far.image, loaded, so_far);
  so_far.image.numbers.erase("vdbeam:complete");
  write_snapshot(so_far, loaded.frame());
}

void FrameRenderer::write_files(const LoadedFrame& loaded, RenderResult& result) const {
  const FrameFiles& files = options_.files;
  const Stopwatch watch;
  ReportContext context;
  context.scene_hash = loaded.hash;
  context.output = output(loaded.frame());
  context.reference = substitute_frame(files.reference, loaded.frame());
  context.second_reference = substitute_frame(files.second_reference, loaded.frame());
  const bool complete = result.stopped_by != "stop";
  display(loaded, result.image);
  std::optional<FrameError> lost;
  const auto attempt = [&](const auto& write) { // of what is not worth an image
    try {
      write();
    } catch (const FrameError& problem) {
      lost = problem;
    }
  };
  const auto write_report = [&] {
    result.statistics.write = watch.seconds();
    write_json_output(report_json(loaded.scene, result, context),
                      path(Output::report, loaded.frame()));
  };
  if (complete) {
    add_metadata(result.image, loaded, result);
    // The image comes last, for it says that the frame is done.
    attempt([&] { write_preview(result, loaded.frame()); });
    if (result.deep && !options_.pass_range) {
      const std::string deep = path(Output::deep, loaded.frame());
      context.deep_bytes = write_deep_exr(*result.deep, result.image, deep);
      send_file(Output::deep, deep, loaded.frame(), result);
    }
    if (!files.report.empty() && !is_stdout(files.report))
      attempt(write_report);
    if (!options_.pass_range) // whose film is written already
      write_image(result.image, context.output, {options_.exposure, options_.view});
    send_file(Output::image, context.output, loaded.frame(), result);
    if (!result.quick_look && result.draft == 0)
      remove_side_files(loaded.frame());
  } else if (result.quick_look) {
    add_metadata(result.image, loaded, result);
    if (why_not_replaceable(path(Output::snapshot, loaded.frame()), Output::snapshot).empty())
      write_snapshot(result, loaded.frame());
  } else if (options_.early_preview) {
    write_preview(result, loaded.frame()); // the quick look has served its time
  }
  if (!files.report.empty()) {
    write_report(); // once more, with the time that writing the image took
    send_file(Output::report, path(Output::report, loaded.frame()), loaded.frame(), result);
  }
  if (lost)
    throw *lost;
}

void FrameRenderer::write_black(const LoadedFrame& loaded) const {
  RenderResult result;
  result.stopped_by = "missing";
  const ImageSettings& size = loaded.scene.image;
  Film film(size.raster_width(), size.raster_height());
  result.image = film.develop();
  result.image.primaries = chromaticities_of(size.working_space);
  if (size.overscan > 0) {
    result.image.x = result.image.y = -size.overscan;
    result.image.full_width = size.width;
    result.image.full_height = size.height;
  }
  add_metadata(result.image, loaded, result);
  if (loaded.scene.image.deep) {
    DeepImage deep;
    deep.width = result.image.width;
    deep.height = result.image.height;
    deep.counts.assign(result.image.channels.front().data.size(), 0);
    write_deep_exr(deep, result.image, path(Output::deep, loaded.frame()));
  }
  write_image(result.image, output(loaded.frame()), {options_.exposure, options_.view});
  send_file(Output::image, output(loaded.frame()), loaded.frame(), result);
  write_preview(result, loaded.frame());
}

/// What shows images before the frame is finished.
RenderHooks FrameRenderer::picture_hooks(const LoadedFrame& loaded, Progress& progress) const {
  RenderHooks hooks;
  hooks.on_step = [frame = loaded.frame()](RenderStep step, int pass) {
    send_step(frame, step, pass);
  };
  hooks.snapshot = &snapshot_requested();
  // A viewer is shown a few images a second, unless files are written more often.
  constexpr double display_interval = 0.25; // seconds
  hooks.snapshot_interval = options_.snapshot;
  if (options_.display && !options_.snapshot.wanted())
    hooks.snapshot_interval.seconds = display_interval;
  hooks.on_snapshot = [&](RenderResult& so_far, bool asked) {
    display(loaded, so_far.image);
    write_so_far(loaded, so_far, asked);
    if (asked)
      progress.note(fmt::format("{}: the image after {}", path(Output::snapshot, loaded.frame()),
                                passes_text(so_far.passes.back().pass)));
  };
  const bool preview = options_.early_preview && !options_.files.preview.empty();
  if (preview || hooks.snapshot_interval.wanted())
    hooks.on_quick_look = [&](RenderResult& look) {
      display(loaded, look.image);
      write_so_far(loaded, look, false);
    };
  return hooks;
}

void FrameRenderer::display(const LoadedFrame& loaded, const Image& image) const {
  if (options_.display)
    options_.display->show(std::filesystem::path(output(loaded.frame())).filename().string(),
                           image);
}

bool FrameRenderer::render_frame(const LoadedFrame& loaded, const std::string& title,
                                 FarmProgress& farm, std::size_t index,
                                 FrameOutcome& outcome) const {
  const Scene& scene = loaded.scene;
  const RenderSettings settings = progress_settings(scene, options_.pass_range);
  Progress progress(title, settings, options_.quiet);
  const std::optional<References> references =
      read_references(options_.files, loaded.frame(), scene.image, StopToken(&stop_requested()));
  if (!references) {
    progress.finish("interrupted while a reference was read");
    return false;
  }
  progress.start(start_text(scene));
  send_frame(scene, settings, output(loaded.frame()), index);
  const auto report_note = [&](const std::string& note) {
    if (!notes_->add(note, loaded.frame()))
      return;
    progress.note(note);
    send_note(loaded.frame(), note);
  };
  for (const std::string& note : scene.notes)
    report_note(note);
  FrameSettings frame;
  frame.pass_range = options_.pass_range;
  frame.region = options_.region;
  if (options_.pass_range)
    frame.partial = output(loaded.frame());
  frame.seconds_used = loaded.seconds_waited;
  frame.checkpoint = options_.checkpoint;
  frame.checkpoint.path = path(Output::checkpoint, loaded.frame());
  frame.reference = references->first ? &*references->first : nullptr;
  frame.second_reference = references->second ? &*references->second : nullptr;
  RenderHooks hooks = picture_hooks(loaded, progress);
  hooks.on_pass = [&](const PassRecord& record, const RenderStatistics& statistics) {
    progress.pass(record);
    farm.frame_at(index, Progress::fraction(record, settings));
    send_pass(loaded.frame(), record, statistics, settings);
  };
  hooks.on_note = report_note;
  hooks.stop = &stop_requested();
  RenderResult result = render(scene, loaded.prepared, frame, hooks);
  write_files(loaded, result);
  if (result.stopped_by == "stop") {
    const std::string snapshot = path(Output::snapshot, loaded.frame());
    const bool taken = !why_not_replaceable(snapshot, Output::snapshot).empty();
    if (!result.quick_look)
      send_file(Output::checkpoint, frame.checkpoint.path, loaded.frame(), result);
    progress.finish(stop_text(result, frame.checkpoint.path, taken ? "" : snapshot));
    return false;
  }
  if (result.quick_look)
    throw FrameError(
        fmt::format("{}: the time limit of {} ended the frame before its first pass: the image is "
                    "a quick look, for viewing only; allow more time or render fewer pixels",
                    output(loaded.frame()), format_duration(*scene.render.time)));
  add_error(outcome, result);
  progress.finish(end_text(result, output(loaded.frame())));
  return true;
}

} // namespace vdbeam::cli
