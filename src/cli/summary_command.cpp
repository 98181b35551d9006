#include "batch/batch_summary.h"
#include "batch/file_claims.h"
#include "batch/output_paths.h"
#include "batch/page_writer.h"
#include "cli/commands.h"
#include "cli/view_option.h"
#include "console/streams.h"
#include "text/printable.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

struct SummaryOptions {
  std::vector<std::string> summaries;
  FrameFiles files;
  double exposure = 0;
  std::string view;
  bool quiet = false;
};

/// One page shows one shot: frames of two scenes would hide each other.
void check_scene(const SummaryOptions& options, const std::vector<BatchSummary>& batches) {
  const auto scene = [](const BatchSummary& batch) {
    return (std::filesystem::path(batch.origin.folder) / batch.scene).lexically_normal().string();
  };
  for (std::size_t i = 1; i < batches.size(); ++i)
    if (scene(batches[i]) != scene(batches[0]))
      throw InputError(one_line(fmt::format(
          "{}: is of the scene {}, {} of {}; make a page for each", options.summaries[i],
          scene(batches[i]), options.summaries[0], scene(batches[0]))));
}

/// What a frame's image is, by the batch whose outcome counts.
struct Picture {
  FrameOutcome outcome;
  std::string path;
};

std::map<int, Picture> pictures_of(const std::vector<BatchSummary>& batches) {
  std::map<int, Picture> pictures;
  for (const auto& [frame, outcome] : outcomes_by_frame(batches))
    pictures[frame].outcome = outcome;
  for (const BatchSummary& batch : batches) {
    for (const FrameOutcome& outcome : batch.outcomes)
      if (Picture& picture = pictures.at(outcome.frame); picture.outcome.output == outcome.output)
        picture.path = image_path(batch, outcome);
  }
  return pictures;
}

int run_summary(const SummaryOptions& options) {
  std::vector<BatchSummary> batches;
  for (const std::string& path : options.summaries)
    batches.push_back(read_summary(path));
  check_scene(options, batches);
  const std::map<int, Picture> pictures = pictures_of(batches);
  std::vector<int> frames;
  for (const auto& [frame, picture] : pictures)
    frames.push_back(frame);
  if (frames.empty())
    frames.push_back(1); // for the checks, which are of one frame at least
  check_output_paths(options.files, frames);
  FileClaims claims;
  for (const std::string& path : options.summaries)
    claims.input("the summary", path);
  for (const auto& [frame, picture] : pictures)
    claims.input(fmt::format("the image of frame {}", frame), picture.path);
  claims.outputs_of(options.files, {Output::page, Output::thumbnail}, frames);
  PageWriter writer(options.files, options.exposure, options.view);
  writer.make_folder();
  for (const auto& [frame, picture] : pictures)
    writer.add(picture.outcome, picture.path);
  writer.write(batches, true);
  if (!writer.problem().empty() && !options.quiet)
    log("note: frames without an image that can be read have no thumbnail: {}", writer.problem());
  if (!options.quiet) {
    BatchSummary all;
    for (const auto& [frame, picture] : pictures)
      all.outcomes.push_back(picture.outcome);
    for (const BatchSummary& batch : batches)
      all.frames.insert(all.frames.end(), batch.frames.begin(), batch.frames.end());
    std::sort(all.frames.begin(), all.frames.end());
    all.frames.erase(std::unique(all.frames.begin(), all.frames.end()), all.frames.end());
    log("{}: {}", output_path(options.files, Output::page, frames.front()), all.text());
  }
  return 0;
}

} // namespace

CommandRun add_summary(CLI::App& app) {
  const auto options = std::make_shared<SummaryOptions>();
  app.add_option("summaries", options->summaries, "Summaries (vdbeam render --summary)")
      ->required()
      ->option_text("SUMMARY.json...");
  app.add_option("--html", options->files.html,
                 "Folder for the page, index.html with thumbnails; made where it is missing")
      ->required()
      ->option_text("FOLDER");
  app.add_option("--exposure", options->exposure, "Exposure of the thumbnails, in stops")
      ->option_text("STOPS");
  add_view(app, options->view);
  app.add_flag("-q,--quiet", options->quiet, "Print errors only");
  app.footer(R"(Several summaries are merged by frame: the latest outcome of a frame counts.

Examples:
  vdbeam render smoke.toml -f 1-24 -o smoke.####.exr --summary smoke.json
  vdbeam summary smoke.json --html page
  vdbeam summary out/summary.*.json --html page     the tasks of a farm)");
  return [options] { return run_summary(*options); };
}

} // namespace vdbeam::cli
