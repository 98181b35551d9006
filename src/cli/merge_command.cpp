#include "batch/file_claims.h"
#include "batch/output_paths.h"
#include "cli/commands.h"
#include "cli/view_option.h"
#include "console/streams.h"
#include "image/output_formats.h"
#include "report/frame_files.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"

#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

struct MergeOptions {
  std::vector<std::string> partials;
  std::string output, preview;
  double exposure = 0;
  std::string view;
  MergeSettings settings;
  bool quiet = false;
};

int run_merge(const MergeOptions& options) {
  const FrameFiles files{.output = options.output, .preview = options.preview};
  check_output_paths(files, {1});
  output_format(options.output);
  const std::string& partial = options.settings.partial;
  check_output_path("--partial", partial, {1});
  if (!partial.empty() && !output_format(partial).complete)
    throw InputError(one_line("--partial " + partial + ": a partial image must be an .exr"));
  FileClaims claims;
  for (const std::string& part : options.partials)
    claims.input("the partial image", part);
  claims.outputs_of(files, {Output::image, Output::deep, Output::preview}, {1});
  claims.output("--partial", partial);
  if (options.settings.passes && *options.settings.passes < 1)
    throw InputError(fmt::format("--passes {}: must be at least 1", *options.settings.passes));
  MergeSettings settings = options.settings;
  settings.deep = output_path(files, Output::deep, 1);
  const Image image = merge_partials(options.partials, settings);
  if (!options.preview.empty())
    write_image(image, options.preview, {options.exposure, options.view});
  write_image(image, options.output, {options.exposure, options.view});
  if (!options.quiet)
    log("{}: {} of {}", options.output,
        count_text(static_cast<std::uint64_t>(image.numbers.at("vdbeam:passes")), "pass"),
        count_text(options.partials.size(), "file"));
  return 0;
}

} // namespace

CommandRun add_merge(CLI::App& app) {
  const auto options = std::make_shared<MergeOptions>();
  app.add_option("partials", options->partials, "Partial images (vdbeam render --pass-range)")
      ->required()
      ->option_text("PARTIAL...");
  app.add_option("-o,--output", options->output, "Image to write: " + output_extensions())
      ->required()
      ->option_text("FILE");
  app.add_option("--passes", options->settings.passes,
                 "Require passes 0 to N - 1; default: 0 to the last one present")
      ->option_text("N");
  app.add_flag("--allow-gaps", options->settings.allow_gaps, "Merge although passes are missing");
  app.add_option("--partial", options->settings.partial,
                 "Also write the merged passes as a partial image, for merging in a tree")
      ->option_text("FILE.exr");
  app.add_option("--preview", options->preview, "Also write an 8-bit sRGB preview")
      ->option_text("FILE.png");
  app.add_option("--exposure", options->exposure, "Exposure of the preview, in stops")
      ->option_text("STOPS");
  add_view(app, options->view);
  app.add_flag("-q,--quiet", options->quiet, "Print errors only");
  app.footer(R"(The image is bit for bit that of an undivided render of the same passes.

Examples:
  vdbeam render cloud.toml --pass-range 0-31 -o a.exr
  vdbeam render cloud.toml --pass-range 32-63 -o b.exr
  vdbeam merge -o cloud.exr --passes 64 a.exr b.exr)");
  return [options] { return run_merge(*options); };
}

} // namespace vdbeam::cli
