#include "cli/commands.h"
#include "cli/frame_renderer.h"
#include "cli/output_paths.h"
#include "cli/scene_options.h"
#include "cli/signals.h"
#include "output/output_formats.h"
#include "scene/frame_range.h"
#include "scene/toml_value.h"
#include "vdbeam/error.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace vdbeam::cli {
namespace {

const char* const examples = R"(Examples:
  vdbeam render cloud.vdb                                 a bare VDB, to cloud.exr
  vdbeam render cloud.toml -o out.exr --time 60s --preview out.png
  vdbeam render smoke.toml -f 1-24 -o smoke.####.exr      a sequence; also 1-100x2, 1,5,9-12, -5--1
  vdbeam render cloud.toml --target-error 0.001 --set volume.0.extinction=80
  vdbeam render cloud.toml --reference ref.exr --report report.json)";

struct RenderOptions {
  SceneOptions scene;
  FrameFiles files;
  std::string frames;
  double exposure = 0;
  bool quiet = false;
};

/// "cloud.toml" gives "cloud.exr"; several frames get a place for their number.
std::string default_output(const std::string& scene, bool several) {
  const std::string stem = std::filesystem::path(scene).stem().string();
  return stem + (several && !has_frame_pattern(stem) ? ".####.exr" : ".exr");
}

std::vector<int> choose_frames(const RenderOptions& options, const SceneDocument& document) {
  if (!options.frames.empty()) {
    try {
      return parse_frame_range(options.frames);
    } catch (const InputError& error) {
      throw InputError(one_line(fmt::format("--frames: {}", error.what())));
    }
  }
  if (!document.has_frame_pattern())
    return {1};
  const std::vector<int> there = document.frames_on_disk();
  throw InputError(one_line(
      fmt::format("{}: the volume is a sequence: say which frames, e.g. -f {}",
                  options.scene.path(), there.empty() ? "1-24" : format_frame_range(there))));
}

/// Everything that can be known to fail is refused before the first frame costs time.
void check_before_rendering(const RenderOptions& options, const SceneDocument& document,
                            const std::vector<int>& frames) {
  check_output_path("-o", options.files.output, frames);
  output_format(options.files.output);
  check_output_path("--preview", options.files.preview, frames);
  if (!options.files.preview.empty())
    output_format(options.files.preview);
  check_output_path("--report", options.files.report, frames);
  for (const int frame : frames)
    document.scene_at(frame);
}

/// Renders all frames. A failed frame does not stop the others; the first failure's code is
/// returned.
int run_render(RenderOptions& options) {
  const SceneDocument document = options.scene.open();
  const std::vector<int> frames = choose_frames(options, document);
  if (options.files.output.empty())
    options.files.output = default_output(options.scene.path(), frames.size() > 1);
  check_before_rendering(options, document, frames);
  handle_signals();
  const FrameRenderer renderer(options.files, options.exposure, options.quiet);
  int code = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string title =
        frames.size() == 1 ? "" : fmt::format("frame {} ({}/{})", frames[i], i + 1, frames.size());
    try {
      renderer.render_frame(document, frames[i], title);
    } catch (const Error& error) {
      if (frames.size() == 1)
        throw;
      fmt::print(stderr, "{}: {}\n", title, error.what());
      code = code == 0 ? static_cast<int>(error.code()) : code;
    }
    if (stop_requested())
      return signal_exit_code();
  }
  return code;
}

} // namespace

CommandRun add_render(CLI::App& app) {
  const auto options = std::make_shared<RenderOptions>();
  options->scene.declare(app);
  app.add_option("-o,--output", options->files.output,
                 "Image to write: .exr or .png; default: the scene's name, .exr, here")
      ->option_text("FILE");
  app.add_option("-f,--frames", options->frames, "Frames: 7, 1-24, 1-100x2, 1,5,9-12")
      ->option_text("RANGE");
  app.add_option("--preview", options->files.preview, "Also write an 8-bit sRGB picture")
      ->option_text("FILE.png");
  app.add_option("--exposure", options->exposure, "Stops that brighten the preview")
      ->option_text("STOPS");
  app.add_option("--reference", options->files.reference,
                 "The true image: errors against it go to the report")
      ->option_text("FILE.exr");
  app.add_option("--report", options->files.report, "Write a JSON report")
      ->option_text("FILE.json");
  app.add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
  app.footer(examples);
  return [options] { return run_render(*options); };
}

} // namespace vdbeam::cli
