#include "batch/file_claims.h"
#include "cli/commands.h"
#include "cli/preview_writer.h"
#include "cli/scene_options.h"
#include "cli/scene_watch.h"
#include "cli/view_option.h"
#include "console/display.h"
#include "console/events.h"
#include "console/signals.h"
#include "console/streams.h"
#include "console/terminal.h"
#include "image/output_formats.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/live.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <unistd.h>
#include <utility>

namespace vdbeam::cli {
namespace {

constexpr std::chrono::milliseconds watch_interval{10};
/// How long a scene file that cannot be read may stay so before the error is printed: editors
/// write in steps.
constexpr std::chrono::milliseconds patience{250};
/// How long the render waits until the look at an edit is in its file.
constexpr std::chrono::milliseconds longest_wait{100};
/// And how long it waits for the last image.
constexpr std::chrono::milliseconds longest_wait_in_the_end{5000};

struct LiveOptions {
  SceneOptions scene;
  std::optional<int> frame;
  std::string preview, display, view, progress = "plain";
  double exposure = 0;
  bool quiet = false, end_with_stdin = false;
};

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// What the user sees of a live session: the preview, the viewer, the log and events.
class LiveView {
public:
  explicit LiveView(const LiveOptions& options)
      : options_(options), name_(std::filesystem::path(options.scene.path()).filename().string()),
        status_line_(!options.quiet && is_smart_terminal(STDERR_FILENO)) {
    if (!options.display.empty())
      display_ = std::make_unique<Display>(options.display);
    if (!options.preview.empty())
      writer_ = std::make_unique<PreviewWriter>(
          options.preview,
          WriteOptions{
              .exposure = options.exposure, .view = options.view, .life = ImageLife::passing},
          [this](const std::string& line) { report_error(line); });
  }
  ~LiveView() { end_status(); }

  LiveHooks hooks() {
    LiveHooks hooks;
    hooks.on_image = [this](LiveImage& image) { show(image); };
    hooks.on_edit = [this](const LiveEdit& edit) { report(edit); };
    hooks.on_error = [this](int, const std::string& line) { report_error(line); };
    hooks.on_finished = [this](int edit) {
      end_status();
      if (writer_)
        writer_->wait(longest_wait_in_the_end); // the last image comes before this event
      send_event("finished", {{"edit", edit}});
      if (!options_.quiet)
        log("finished; waiting for edits, Ctrl+C ends");
    };
    return hooks;
  }

  void report_error(const std::string& line) {
    end_status();
    log_error(fmt::format("error: {}", line));
    send_event("message", {{"level", "error"}, {"text", line}});
  }

private:
  void show(LiveImage& shown) {
    if (display_)
      display_->show(name_, shown.image);
    const nlohmann::ordered_json event = image_event(shown);
    if (writer_)
      writer_->write(std::move(shown.image), [event] { send_event("image", event); });
    else
      send_event("image", event);
    if (writer_ && shown.passes == 0 && !shown.mixed) // else passes would take its processors
      writer_->wait(longest_wait);
    status(shown);
  }

  nlohmann::ordered_json image_event(const LiveImage& shown) const {
    nlohmann::ordered_json event{{"edit", shown.edit},
                                 {"passes", shown.passes},
                                 {"mixed", shown.mixed},
                                 {"seconds", shown.seconds}};
    if (shown.record) {
      event["error"] = number(shown.record->error_estimate);
      event["error_low"] = number(shown.record->error_low);
      event["error_high"] = number(shown.record->error_high);
    }
    if (writer_)
      event["path"] = std::filesystem::absolute(options_.preview).string();
    return event;
  }

  void report(const LiveEdit& edit) {
    send_event("edit", {{"edit", edit.edit},
                        {"changed", edit.changed},
                        {"mixed", edit.mixed},
                        {"grids_read", edit.grids_read},
                        {"meshes_read", edit.meshes_read},
                        {"trees_built", edit.trees_built}});
    end_status();
    if (!options_.quiet)
      log("edit {}: {}", edit.edit, description(edit));
  }

  static std::string description(const LiveEdit& edit) {
    constexpr std::size_t most_keys = 4;
    std::string keys;
    for (std::size_t i = 0; i < std::min(most_keys, edit.changed.size()); ++i)
      keys += (i > 0 ? ", " : "") + edit.changed[i];
    if (edit.changed.size() > most_keys)
      keys += fmt::format(" and {} more", edit.changed.size() - most_keys);
    if (edit.edit == 1)
      keys = "the scene";
    else if (keys.empty())
      keys = "files of the scene";
    if (edit.mixed)
      return keys + "; mixed from the images of the lights, the render goes on";
    return fmt::format("{}; read {} grids and {} meshes, built {} trees, kept the rest", keys,
                       edit.grids_read, edit.meshes_read, edit.trees_built);
  }

  /// On a terminal, one line that changes; in a log nothing, or it would fill.
  void status(const LiveImage& shown) {
    if (!status_line_)
      return;
    std::string text = shown.passes == 0 ? "quick look" : fmt::format("{} passes", shown.passes);
    if (shown.record && std::isfinite(shown.record->error_estimate)) {
      // Half of the error takes twice the passes.
      text += fmt::format(", error {:.3g} ({:.3g} to {:.3g}), half of it in {}",
                          shown.record->error_estimate, shown.record->error_low,
                          shown.record->error_high, format_duration(shown.record->seconds));
    }
    const auto columns = static_cast<std::size_t>(terminal_columns(STDERR_FILENO));
    log_text("\r\033[K" + text.substr(0, columns > 1 ? columns - 1 : 1));
    status_shown_ = true;
  }
  void end_status() {
    if (status_shown_)
      log_text("\r\033[K");
    status_shown_ = false;
  }

  const LiveOptions& options_;
  std::string name_;
  std::unique_ptr<Display> display_;
  bool status_line_, status_shown_ = false;
  std::unique_ptr<PreviewWriter> writer_; ///< the last member: it uses the others
};

/// Reads the scene again where its files change, and shows it.
class LiveLoop {
public:
  /// `watch` has begun before the document was read.
  LiveLoop(const LiveOptions& options, int frame, const SceneDocument& document, SceneWatch watch)
      : options_(options), frame_(frame), watch_(std::move(watch)), view_(options),
        session_(view_.hooks()) {
    watch_.name_files(document, frame_);
    session_.show(document.scene_at(frame_));
  }

  void run() {
    while (!stop_requested()) {
      std::this_thread::sleep_for(watch_interval);
      if (const std::vector<std::string> changed = watch_.changed(); !changed.empty())
        load(changed);
      else if (unread_ && std::chrono::steady_clock::now() > unread_->since + patience)
        view_.report_error(std::exchange(unread_, std::nullopt)->line);
    }
  }

private:
  struct Unread {
    std::string line;
    std::chrono::steady_clock::time_point since;
  };

  void load(const std::vector<std::string>& changed) {
    files_changed_ = files_changed_ || !watch_.only_scene(changed) ||
                     is_vdb_file(options_.scene.path()); // which is a scene, and its volume
    unread_.reset();
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
      session_.show(std::move(scene), std::exchange(files_changed_, false));
    } catch (const InputError& error) {
      unread_ = Unread{error.what(), std::chrono::steady_clock::now()};
    }
  }

  const LiveOptions& options_;
  int frame_;
  SceneWatch watch_;
  LiveView view_;
  LiveSession session_;
  bool files_changed_ = false;
  std::optional<Unread> unread_;
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
