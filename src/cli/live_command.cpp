#include "batch/file_claims.h"
#include "batch/output_paths.h"
#include "cli/commands.h"
#include "cli/live_view.h"
#include "cli/scene_options.h"
#include "cli/scene_watch.h"
#include "cli/view_option.h"
#include "console/events.h"
#include "console/signals.h"
#include "image/output_formats.h"
#include "vdbeam/error.h"
#include "vdbeam/live.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace vdbeam::cli {
namespace {

constexpr std::chrono::milliseconds watch_interval{10};
/// How long a file that cannot be read may stay so before the error is printed: editors and
/// simulations write in steps.
constexpr std::chrono::milliseconds patience{250};

struct LiveOptions {
  SceneOptions scene;
  std::optional<int> frame;
  std::string preview, display, view, progress = "plain";
  double exposure = 0;
  bool quiet = false, end_with_stdin = false;
};

LiveViewOptions view_options(const LiveOptions& options) {
  return {.name = std::filesystem::path(options.scene.path()).filename().string(),
          .preview = options.preview,
          .display = options.display,
          .view = options.view,
          .exposure = options.exposure,
          .quiet = options.quiet};
}

/// An error that may pass: files that are read while they are written look damaged.
class PendingError {
public:
  void set(int edit, const std::string& line) {
    const std::lock_guard lock(mutex_);
    edit_ = edit;
    line_ = line;
    since_ = std::chrono::steady_clock::now();
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    line_.reset();
  }
  /// Returns the error of the latest edit, once, if it has lasted that long.
  std::optional<std::string> take(int latest_edit, std::chrono::milliseconds age) {
    const std::lock_guard lock(mutex_);
    if (!line_ || edit_ < latest_edit || std::chrono::steady_clock::now() < since_ + age)
      return std::nullopt;
    return std::exchange(line_, std::nullopt);
  }

private:
  std::mutex mutex_;
  int edit_ = 0;
  std::optional<std::string> line_;
  std::chrono::steady_clock::time_point since_;
};

/// Reads the scene again where its files change, and shows it.
class LiveLoop {
public:
  /// `watch` has begun before the document was read.
  LiveLoop(const LiveOptions& options, int frame, const SceneDocument& document, SceneWatch watch)
      : options_(options), frame_(frame), watch_(std::move(watch)), view_(view_options(options)),
        session_(hooks()) {
    watch_.name_files(document, frame_);
    edit_ = session_.show(document.scene_at(frame_));
  }

  void run() {
    while (!stop_requested()) {
      std::this_thread::sleep_for(watch_interval);
      if (const std::vector<std::string> changed = watch_.changed(); !changed.empty())
        load(changed);
      else
        report_error(patience);
    }
    report_error({});
  }

private:
  LiveHooks hooks() {
    LiveHooks hooks;
    hooks.on_image = [this](LiveImage& image) { view_.show(image); };
    hooks.on_edit = [this](const LiveEdit& edit) { view_.report(edit); };
    hooks.on_error = [this](int edit, const std::string& line) { error_.set(edit, line); };
    hooks.on_finished = [this](int edit) { view_.report_end(edit); };
    return hooks;
  }

  void report_error(std::chrono::milliseconds age) {
    if (const std::optional<std::string> line = error_.take(edit_, age)) {
      view_.report_error(*line);
      mistaken_ = true;
    }
  }

  void load(const std::vector<std::string>& changed) {
    files_changed_ = files_changed_ || !watch_.only_scene(changed) ||
                     is_vdb_file(options_.scene.path()); // which is a scene, and its volume
    error_.clear();
    try {
      watch_.look_again(); // before reading: what changes meanwhile is read once more
      if (std::error_code no_size;
          std::filesystem::file_size(options_.scene.path(), no_size) == 0 && !no_size)
        throw InputError(options_.scene.path() + ": the file is empty"); // about to be written
      const SceneDocument document = options_.scene.open();
      watch_.name_files(document, frame_);
      Scene scene = document.scene_at(frame_);
      FileClaims claims;
      claims.scene(document, options_.scene.path(), {frame_});
      claims.output("--preview", options_.preview);
      const int edit = session_.show(std::move(scene), std::exchange(files_changed_, false));
      if (edit == edit_ && mistaken_)
        view_.report_repaired();
      edit_ = edit;
      mistaken_ = false;
    } catch (const InputError& error) {
      error_.set(edit_, error.what());
    }
  }

  const LiveOptions& options_;
  int frame_;
  SceneWatch watch_;
  LiveView view_;
  PendingError error_;
  bool files_changed_ = false;
  bool mistaken_ = false; ///< the last message is an error
  int edit_ = 0;          ///< that is shown
  LiveSession session_;   ///< the last member: it calls back
};

int run_live(LiveOptions& options) {
  if (options.progress == "json")
    enable_events();
  SceneWatch watch(options.scene.path());
  const SceneDocument document = options.scene.open();
  if (options.preview.empty() && options.display.empty())
    options.preview = std::filesystem::path(options.scene.path()).stem().string() + ".live.png";
  if (!options.preview.empty())
    output_format(options.preview);
  const int frame = choose_frame(options.frame, document);
  FileClaims claims;
  claims.scene(document, options.scene.path(), {frame});
  claims.output("--preview", options.preview);
  check_output_path("--preview", options.preview, {frame});
  handle_signals();
  if (options.end_with_stdin)
    end_with_stdin();
  LiveLoop(options, frame, document, std::move(watch)).run();
  return 0;
}

} // namespace

CommandRun add_live(CLI::App& app) {
  const auto options = std::make_shared<LiveOptions>();
  options->scene.declare(app);
  app.add_option("-f,--frame", options->frame, "Frame number; default: the first on disk, or 1")
      ->option_text("N");
  app.add_option(
         "--preview", options->preview,
         "Image that is replaced in one step, .png or linear .exr; default: NAME.live.png of "
         "the scene, unless there is a --display")
      ->option_text("FILE");
  app.add_option("--display", options->display,
                 "Show the image in the viewer tev, e.g. localhost:14158")
      ->option_text("HOST:PORT");
  app.add_option("--exposure", options->exposure, "Exposure of the preview, in stops")
      ->option_text("STOPS");
  add_view(app, options->view);
  app.add_option("--progress", options->progress,
                 "Format of progress lines on stdout: json for other programs; default: plain "
                 "(none)")
      ->check(CLI::IsMember({"plain", "json"}))
      ->option_text("plain|json");
  app.add_flag("-q,--quiet", options->quiet, "Print errors only");
  app.add_flag(
      "--end-with-stdin", options->end_with_stdin,
      "End when the standard input is closed, as when the program that started this one is "
      "killed");
  app.footer(R"(The scene is rendered again whenever it, or a file that it names, is saved. What did
not change is kept; strengths and colours of lights are changed at once. Ctrl+C ends.

Examples:
  vdbeam live cloud.toml                                 replaces cloud.live.png
  vdbeam live cloud.toml --display localhost:14158       in the viewer tev
  vdbeam live smoke.toml -f 12 --resolution 960x540)");
  return [options] { return run_live(*options); };
}

} // namespace vdbeam::cli
