#include "batch/batch.h"
#include "batch/file_claims.h"
#include "batch/output_paths.h"
#include "batch/still_note.h"
#include "cli/batch_values.h"
#include "cli/check_render.h"
#include "cli/commands.h"
#include "cli/help_format.h"
#include "cli/scene_options.h"
#include "cli/usage_error.h"
#include "cli/view_option.h"
#include "console/display.h"
#include "console/signals.h"
#include "console/streams.h"
#include "farm/farm_job.h"
#include "image/output_formats.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>

namespace vdbeam::cli {
namespace {

const char* const examples = R"(Examples:
  vdbeam render cloud.vdb                                 a bare VDB, to cloud.exr
  vdbeam render cloud.toml -o out.exr --time 60s --preview out.png
  vdbeam render smoke.toml -f 1-24 -o smoke.####.exr      a sequence; also 1-100x2, 1,5,9-12
  vdbeam render cloud.toml --target-error 0.001 --set volume.0.extinction=80
  vdbeam render smoke.toml -f 1-240 -o smoke.####.exr --skip-existing --checkpoint 5m
  vdbeam render smoke.toml -f 1-240 -o smoke.####.exr --html page
  vdbeam render cloud.toml --pass-range 0-31 -o part0.exr
  vdbeam render cloud.toml --reference ref.exr --report report.json)";

struct RenderOptions {
  SceneOptions scene;
  BatchOptions batch;
  std::string frames, pass_range, region, checkpoint, snapshot, display;
  bool no_resume = false, overwrite = false, end_with_stdin = false;
};

/// "cloud.toml" gives "cloud.exr"; several frames get a place for their number, and passes of a
/// frame their range, so that nobody takes them for a finished picture.
std::string default_output(const RenderOptions& options, bool several) {
  const std::string stem = std::filesystem::path(options.scene.path()).stem().string();
  return partial_path(stem + (several && !has_frame_pattern(stem) ? ".####.exr" : ".exr"),
                      options.pass_range);
}

/// The number of "smoke.0020.vdb" or "smoke_0020.vdb"; 1 where the name has none.
int frame_of_name(const std::string& vdb) {
  constexpr std::size_t most_digits = 8, fewest_after_underscore = 3; // "cloud_v2" is a version
  const std::string stem = std::filesystem::path(vdb).stem().string();
  const std::size_t before = stem.find_last_not_of("0123456789");
  if (before == stem.npos || before + 1 == stem.size())
    return 1;
  const std::string digits = stem.substr(before + 1);
  const bool numbered =
      stem[before] == '.' || (stem[before] == '_' && digits.size() >= fewest_after_underscore);
  return numbered && digits.size() <= most_digits ? std::stoi(digits) : 1;
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
    return {is_vdb_file(options.scene.path()) ? frame_of_name(options.scene.path()) : 1};
  const std::vector<int> there = document.frames_on_disk();
  throw InputError(one_line(
      fmt::format("{}: the volume is a sequence; give a range of frames, e.g. -f {}",
                  options.scene.path(), there.empty() ? "1-24" : format_frame_range(there))));
}

void check_options(const RenderOptions& options) {
  const FrameOptions& frame = options.batch.frame;
  const bool exr = output_format(frame.files.output).complete;
  if (!exr && frame.pass_range)
    throw InputError(one_line("-o " + frame.files.output + ": a partial image must be an .exr"));
  if (!exr && options.batch.skip_existing)
    throw InputError(
        one_line("-o " + frame.files.output +
                 ": --skip-existing needs an .exr; other files do not record scene and frame"));
  if (!frame.parts.empty() && (frame.pass_range || !exr))
    throw InputError("--from-parts: excludes --pass-range, and -o must be an .exr");
  if (!frame.merged.empty() && (!frame.pass_range || !options.batch.skip_existing))
    throw InputError("--skip-merged: belongs to --pass-range and --skip-existing");
  if (frame.region && !frame.files.reference.empty())
    throw InputError("--reference: excludes --region");
  if (frame.files.reference.empty() && !frame.files.second_reference.empty())
    throw InputError("--second-reference: belongs to --reference; give both");
  if (frame.pass_range && !frame.files.html.empty())
    throw InputError(
        "--html: excludes --pass-range; render the merge with --html, or make the page "
        "with vdbeam summary");
  if (frame.pass_range && options.batch.missing == MissingFile::black)
    throw InputError("--missing black: excludes --pass-range");
}

/// Refuses outputs that would replace an input or each other.
void check_clashes(const RenderOptions& options, const SceneDocument& document,
                   const std::vector<int>& frames) {
  const FrameFiles& files = options.batch.frame.files;
  FileClaims claims;
  claims.scene(document, options.scene.path(), frames);
  claims.inputs("--reference", files.reference, frames);
  claims.inputs("--second-reference", files.second_reference, frames);
  claims.inputs("--skip-merged", options.batch.frame.merged, frames);
  for (const std::string& part : options.batch.frame.parts)
    claims.inputs("--from-parts", part, frames);
  if (options.batch.farm != FarmFormat::plain)
    claims.output("--progress", "-");
  claims.render(files, frames);
}

/// Refuses what is wrong with every frame. What only some of them lack is reported when their turn
/// comes, so that the others are rendered.
void check_scenes(const RenderOptions& options, const SceneDocument& document,
                  const std::vector<int>& frames) {
  std::optional<InputError> first;
  for (const int frame : frames) {
    try {
      document.scene_at(frame, options.batch.missing);
      return;
    } catch (const InputError& error) {
      if (!first)
        first = error;
    }
  }
  throw *first;
}

/// Everything that can be known to fail is refused before the first frame costs time.
void check_before_rendering(const RenderOptions& options, const SceneDocument& document,
                            const std::vector<int>& frames) {
  const FrameFiles& files = options.batch.frame.files;
  check_output_paths(files, frames);
  output_format(files.output);
  if (!files.preview.empty())
    output_format(files.preview);
  check_options(options);
  check_clashes(options, document, frames);
  check_scenes(options, document, frames);
}

/// Fills in what the options say as text, and what they leave open; refuses what cannot work.
std::vector<int> check_command(RenderOptions& options, const SceneDocument& document) {
  std::vector<int> frames = choose_frames(options, document);
  FrameOptions& frame = options.batch.frame;
  if (frame.files.output.empty())
    frame.files.output = default_output(options, frames.size() > 1);
  if (!options.pass_range.empty())
    frame.pass_range = parse_pass_range(options.pass_range);
  if (!options.region.empty())
    frame.region = parse_region(options.region);
  if (!options.checkpoint.empty())
    frame.checkpoint = parse_checkpoint(options.checkpoint);
  if (!options.snapshot.empty())
    frame.snapshot = parse_snapshot(options.snapshot);
  frame.checkpoint.resume = !options.no_resume;
  frame.early_preview = frames.size() == 1; // of a shot nobody watches every frame
  if (options.overwrite)
    options.batch.skip_existing = false;
  check_before_rendering(options, document, frames);
  return frames;
}

/// Renders all frames.
int run_render(RenderOptions& options) {
  const SceneDocument document = options.scene.open();
  const std::vector<int> frames = check_command(options, document);
  const FrameOptions& frame = options.batch.frame;
  const FrameFiles& files = frame.files;
  if (const std::string note = still_note(document, options.scene.path(), frames);
      !note.empty() && !frame.quiet)
    log("note: {}", note);
  if (frame.exposure != 0 && files.preview.empty() &&
      output_format(files.output).extension == ".exr" && !frame.quiet)
    log("note: --exposure affects only a --preview or a .png; there is none");
  if (!options.display.empty())
    options.batch.frame.display =
        std::make_shared<Display>(options.display, [quiet = frame.quiet](const std::string& line) {
          if (!quiet)
            log_line(line);
        });
  handle_signals();
  if (options.end_with_stdin)
    end_with_stdin();
  return Batch(document, options.scene.path(), frames, options.batch).run();
}

template <class E>
CLI::Option* add_choice(CLI::App& app, const std::string& name, E& target,
                        const std::map<std::string, E>& choices, const std::string& description) {
  std::string words;
  for (const auto& [word, value] : choices)
    words += (words.empty() ? "" : "|") + word;
  return app
      .add_option_function<std::string>(
          name, [&target, choices](const std::string& word) { target = choices.at(word); },
          description)
      ->check(CLI::IsMember(choices))
      ->option_text(words);
}

void add_batch_options(CLI::App& app, RenderOptions& options) {
  BatchOptions& batch = options.batch;
  app.add_option("--pass-range", options.pass_range,
                 "Render passes A to B, counted from 0, into a partial EXR for vdbeam merge")
      ->option_text("A-B");
  app.add_option("--region", options.region,
                 "Render only the pixels with x0 <= x < x1 and y0 <= y < y1")
      ->option_text("X0,Y0,X1,Y1");
  app.add_option("--checkpoint", options.checkpoint,
                 "Save a checkpoint at this interval: 300s, 5m, or a number of passes")
      ->option_text("T|N");
  app.add_option("--snapshot", options.snapshot,
                 "Write the image so far to NAME.snapshot.exr and --preview at this interval: 2s, "
                 "or a number of passes")
      ->option_text("T|N");
  app.add_option("--display", options.display,
                 "Show the image in the viewer tev while it is rendered, e.g. localhost:14158")
      ->option_text("HOST:PORT");
  app.add_flag("--no-resume", options.no_resume, "Do not resume from a checkpoint");
  app.add_flag("--skip-existing", batch.skip_existing,
               "Skip frames whose finished image of this scene exists");
  app.add_option(
         "--skip-merged", batch.frame.merged,
         "With --pass-range and --skip-existing: also skip frames whose merged image exists")
      ->option_text("FILE.exr");
  app.add_option(
         "--from-parts", batch.frame.parts,
         "Merge this partial image instead of rendering, then remove it; repeat for each part")
      ->take_all()
      ->allow_extra_args(false)
      ->option_text("PARTIAL");
  app.add_flag("--overwrite", options.overwrite, "Render all frames; overrides --skip-existing");
  add_choice<bool>(app, "--on-error", batch.stop_on_error, {{"continue", false}, {"stop", true}},
                   "After a failed frame, render the others or stop; default: continue");
  add_choice<MissingFile>(
      app, "--missing", batch.missing,
      {{"error", MissingFile::error}, {"black", MissingFile::black}, {"hold", MissingFile::hold}},
      "A frame whose volume file is missing fails, is black, or holds the previous file; default: "
      "error");
  app.add_option("--summary", batch.frame.files.summary,
                 "Write the result of each frame as JSON; - is stdout")
      ->option_text("FILE.json");
  app.add_option("--html", batch.frame.files.html,
                 "Write a page about the batch to this folder, replaced after each frame")
      ->option_text("FOLDER");
  add_choice<FarmFormat>(
      app, "--progress", batch.farm,
      {{"plain", FarmFormat::plain},
       {"openjd", FarmFormat::openjd},
       {"alf", FarmFormat::alf},
       {"json", FarmFormat::json}},
      "Format of progress lines on stdout, for farm engines (alf, openjd) and other programs "
      "(json); default: plain (none)");
}

void declare(CLI::App& app, const std::shared_ptr<RenderOptions>& options) {
  options->scene.declare(app);
  app.add_option("-o,--output", options->batch.frame.files.output,
                 "Image to write: " + output_extensions() +
                     "; default: NAME.exr of the scene, in the current folder")
      ->option_text("FILE");
  app.add_option("-f,--frames", options->frames, "Frames: 7, 1-24, 1-100x2, 1,5,9-12")
      ->option_text("RANGE");
  app.add_option("--preview", options->batch.frame.files.preview,
                 "Also write an 8-bit sRGB preview")
      ->option_text("FILE.png");
  app.add_option("--exposure", options->batch.frame.exposure, "Exposure of the preview, in stops")
      ->option_text("STOPS");
  add_view(app, options->batch.frame.view);
  app.add_option("--reference", options->batch.frame.files.reference,
                 "Reference image; the report gives the error against it")
      ->option_text("FILE.exr");
  app.add_option("--second-reference", options->batch.frame.files.second_reference,
                 "A second, independent reference: removes the references' noise from the error")
      ->option_text("FILE.exr");
  app.add_option("--report", options->batch.frame.files.report, "Write a JSON report; - is stdout")
      ->option_text("FILE.json");
  app.add_flag("-q,--quiet", options->batch.frame.quiet, "Print errors only");
  app.add_flag(
      "--end-with-stdin", options->end_with_stdin,
      "End when the standard input is closed, as when the program that started this one is "
      "killed");
  add_batch_options(app, *options);
  group_options(app, "Output",
                {"-o", "--preview", "--snapshot", "--display", "--exposure", "--region",
                 "--reference", "--second-reference", "--report"});
  group_options(app, "Sequences and farms",
                {"-f", "--skip-existing", "--overwrite", "--on-error", "--missing", "--checkpoint",
                 "--no-resume", "--pass-range", "--summary", "--html", "--progress"});
}

} // namespace

CommandRun add_render(CLI::App& app) {
  const auto options = std::make_shared<RenderOptions>();
  declare(app, options);
  app.footer(examples);
  return [options] { return run_render(*options); };
}

void check_render_command(const std::vector<std::string>& words, const SceneDocument& document,
                          const std::vector<std::string>& scene_words) {
  CLI::App app("", "vdbeam render");
  const auto options = std::make_shared<RenderOptions>();
  declare(app, options);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    throw InputError(usage_error(app, words, error));
  }
  if (options->scene.words() == scene_words)
    check_command(*options, document);
  else
    check_command(*options, options->scene.open());
}

} // namespace vdbeam::cli
