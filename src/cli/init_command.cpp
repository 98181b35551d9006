#include "batch/file_claims.h"
#include "batch/output_paths.h"
#include "cli/commands.h"
#include "console/streams.h"
#include "farm/farm_job.h"
#include "machine/atomic_file.h"
#include "scene/scene_document.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string volume, output;
  bool force = false, all = false;
};

int run_init(const InitOptions& options) {
  if (options.output.empty() || is_stdout(options.output)) {
    print_output(scene_template(options.volume, "", options.all));
    return 0;
  }
  check_output_path("-o", options.output, {1});
  FileClaims claims;
  claims.inputs("the volume", options.volume, frames_on_disk(options.volume));
  claims.output("-o", options.output);
  std::error_code error;
  if (!options.force && fs::exists(options.output, error))
    throw InputError(one_line(fmt::format("-o {}: exists; --force replaces it", options.output)));
  const std::string text =
      scene_template(options.volume, fs::path(options.output).parent_path().string(), options.all);
  AtomicFile file(options.output);
  file.write(text.data(), text.size());
  file.commit();
  const std::vector<int> frames =
      has_frame_pattern(options.volume) ? frames_on_disk(options.volume) : std::vector<int>{};
  log("{}: written; render it with: vdbeam render {}{}", options.output, shell_word(options.output),
      frames.empty() ? "" : " -f " + format_frame_range(frames));
  return 0;
}

} // namespace

CommandRun add_init(CLI::App& app) {
  const auto options = std::make_shared<InitOptions>();
  app.add_option("volume", options->volume, "VDB file (#### for the frame number of a sequence)")
      ->required()
      ->option_text("VDB");
  app.add_option("-o,--output", options->output, "Scene file to write; default: standard output")
      ->option_text("FILE.toml");
  app.add_flag("--all", options->all, "Write all keys, not only those that matter first");
  app.add_flag("--force", options->force, "Replace an existing file");
  app.footer(R"(Examples:
  vdbeam init cloud.vdb -o cloud.toml
  vdbeam init 'smoke/smoke.####.vdb' -o smoke.toml)");
  return [options] { return run_init(*options); };
}

} // namespace vdbeam::cli
