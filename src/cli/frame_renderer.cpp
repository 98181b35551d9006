#include "cli/frame_renderer.h"

#include "cli/progress.h"
#include "cli/signals.h"
#include "output/output_formats.h"
#include "scene/frame_range.h"
#include "scene/image_metadata.h"
#include "scene/report.h"
#include "scene/scene_enums.h"
#include "scene/text.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/scene_file.h"

#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

namespace vdbeam::cli {
namespace {

/// The reference, which must have the picture's size, before any time goes into rendering.
Image read_reference(const std::string& path, const ImageSettings& size) {
  Image reference = read_image(path);
  if (reference.width != size.width || reference.height != size.height)
    throw InputError(fmt::format("--reference {}: is {}x{}, but the picture is {}x{}; use "
                                 "--resolution {}x{}",
                                 path, reference.width, reference.height, size.width, size.height,
                                 reference.width, reference.height));
  for (const char* channel : {"R", "G", "B"})
    if (!reference.find(channel))
      throw InputError(fmt::format("--reference {}: has no channel {}", path, channel));
  return reference;
}

std::string start_text(const Scene& scene) {
  return fmt::format("{}, {}, {}x{}", scene.path, enum_name(scene.render.estimator),
                     scene.image.width, scene.image.height);
}

std::string end_text(const RenderResult& result, const std::string& output) {
  const PassRecord& last = result.passes.back();
  std::string text =
      fmt::format("{}{}: {} {} in {}", result.stopped_by == "stop" ? "interrupted, " : "", output,
                  last.pass, last.pass == 1 ? "pass" : "passes", format_duration(last.seconds));
  if (std::isfinite(last.error_estimate))
    text += fmt::format(", estimated error (MRSE) {:.2g}", last.error_estimate);
  if (last.has_reference)
    text += fmt::format(", MRSE {:.3g}, bias {:+.2f} %", last.mrse, 100 * last.bias);
  return text + ", peak memory " + format_bytes(static_cast<double>(result.statistics.peak_memory));
}

} // namespace

void FrameRenderer::write_files(const Scene& scene, RenderResult& result, int frame) const {
  const auto begin = std::chrono::steady_clock::now();
  ReportContext context;
  context.frame = frame;
  context.scene_hash = scene_hash(scene);
  context.output = substitute_frame(files_.output, frame);
  context.reference = substitute_frame(files_.reference, frame);
  add_image_metadata(result.image, scene, result, frame, context.scene_hash);
  write_image(result.image, context.output, {exposure_});
  if (!files_.preview.empty())
    write_image(result.image, substitute_frame(files_.preview, frame), {exposure_});
  result.statistics.write =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!files_.report.empty())
    write_json(report_json(scene, result, context), substitute_frame(files_.report, frame));
}

void FrameRenderer::render_frame(const SceneDocument& document, int frame,
                                 const std::string& title) const {
  const Scene scene = document.scene_at(frame);
  Progress progress(title, scene.render, quiet_);
  std::optional<Image> reference;
  if (!files_.reference.empty())
    reference = read_reference(substitute_frame(files_.reference, frame), scene.image);
  progress.start(start_text(scene));
  for (const std::string& note : scene.notes)
    progress.note(note);
  RenderHooks hooks;
  hooks.on_pass = [&](const PassRecord& record, const RenderStatistics&) { progress.pass(record); };
  hooks.on_note = [&](const std::string& note) { progress.note(note); };
  hooks.stop = &stop_requested();
  hooks.reference = reference ? &*reference : nullptr;
  hooks.frame = frame;
  RenderResult result = render(scene, hooks);
  if (result.passes.empty())
    throw FrameError(fmt::format("{}: no pass was finished; nothing is written", scene.path));
  write_files(scene, result, frame);
  progress.finish(end_text(result, substitute_frame(files_.output, frame)));
}

} // namespace vdbeam::cli
