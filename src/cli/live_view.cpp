#include "cli/live_view.h"

#include "console/events.h"
#include "console/streams.h"
#include "console/terminal.h"
#include "machine/memory.h"
#include "text/text.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>
#include <utility>

namespace vdbeam::cli {
namespace {

/// How long the render waits until the look at an edit is in its file.
constexpr std::chrono::milliseconds longest_wait{100};
/// And how long it waits for the last image.
constexpr std::chrono::milliseconds longest_wait_in_the_end{5000};

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

std::string count(std::uint64_t number, const char* noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

/// Passes of an image, and its error as far as it is known.
std::string progress_of(const LiveImage& image) {
  if (image.passes == 0)
    return "quick look";
  std::string text = count(static_cast<std::uint64_t>(image.passes), "pass");
  if (image.passes != 1)
    text.replace(text.size() - 1, 1, "es");
  if (!image.record || !std::isfinite(image.record->error_estimate))
    return text;
  const PassRecord& record = *image.record;
  text += fmt::format(", error {:.3g}", record.error_estimate);
  if (std::isfinite(record.error_low) && std::isfinite(record.error_high))
    text += fmt::format(" ({:.3g} to {:.3g})", record.error_low, record.error_high);
  return text;
}

/// Keys that an edit has changed.
std::string keys_of(const LiveEdit& edit) {
  constexpr std::size_t most_keys = 4;
  if (edit.edit == 1)
    return "the scene";
  if (edit.changed.empty())
    return "files of the scene";
  std::string keys;
  for (std::size_t i = 0; i < std::min(most_keys, edit.changed.size()); ++i)
    keys += (i > 0 ? ", " : "") + edit.changed[i];
  if (edit.changed.size() > most_keys)
    keys += fmt::format(" and {} more", edit.changed.size() - most_keys);
  return keys;
}

/// Describes the work for an edit: it lists what was read, built and kept.
std::string work_of(const LiveEdit& edit) {
  if (edit.grids_read + edit.meshes_read + edit.trees_built == 0 && !edit.kept.empty())
    return fmt::format("kept {}", fmt::join(edit.kept, "; "));
  const std::string read =
      fmt::format("read {} and {}, built {}", count(edit.grids_read, "grid"),
                  edit.meshes_read == 1 ? "1 mesh" : fmt::format("{} meshes", edit.meshes_read),
                  count(edit.trees_built, "tree"));
  return edit.kept.empty() ? read : fmt::format("{}, kept {}", read, fmt::join(edit.kept, "; "));
}

} // namespace

LiveView::LiveView(LiveViewOptions options)
    : options_(std::move(options)),
      status_line_(!options_.quiet && is_smart_terminal(STDERR_FILENO)) {
  if (!options_.display.empty())
    display_ = std::make_unique<Display>(options_.display, [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      if (!options_.quiet)
        print(line);
    });
  if (!options_.preview.empty())
    writer_ = std::make_unique<PreviewWriter>(
        options_.preview,
        WriteOptions{
            .exposure = options_.exposure, .view = options_.view, .life = ImageLife::passing},
        [this](const std::string& line) {
          if (line != std::exchange(write_error_, line)) // a full disk refuses every image
            report_error(line);
        });
}

LiveView::~LiveView() {
  const std::lock_guard lock(mutex_);
  if (status_shown_)
    log_text("\r\033[K");
}

void LiveView::show(LiveImage& shown) {
  const bool first_look = shown.passes == 0 && !shown.mixed;
  if (display_)
    display_->show(options_.name, shown.image);
  const nlohmann::ordered_json event = image_event(shown);
  if (writer_)
    writer_->write(std::move(shown.image), [this, event] {
      write_error_.clear();
      send_event("image", event);
    });
  else
    send_event("image", event);
  if (writer_ && first_look) // else passes would take its processors
    writer_->wait(longest_wait);
  const std::lock_guard lock(mutex_);
  progress_ = progress_of(shown);
  std::string status = progress_;
  if (shown.passes > 0 && shown.record && std::isfinite(shown.record->error_estimate))
    // Half of the error takes twice the passes.
    status += fmt::format(", half of it in {}", format_duration(shown.record->seconds));
  show_status(status);
}

void LiveView::report(const LiveEdit& edit) {
  send_event("edit", {{"edit", edit.edit},
                      {"changed", edit.changed},
                      {"mixed", edit.mixed},
                      {"grids_read", edit.grids_read},
                      {"meshes_read", edit.meshes_read},
                      {"trees_built", edit.trees_built},
                      {"kept", edit.kept}});
  const std::lock_guard lock(mutex_);
  const bool goes_on = edit.mixed && !finished_;
  finished_ = finished_ && edit.mixed;
  if (options_.quiet)
    return;
  if (edit.mixed)
    print(fmt::format("edit {}: {}; shown at once{}", edit.edit, keys_of(edit),
                      goes_on ? ", the render goes on" : ""));
  else
    print(fmt::format("edit {}: {}; {}", edit.edit, keys_of(edit), work_of(edit)));
}

void LiveView::report_end(int edit) {
  if (writer_)
    writer_->wait(longest_wait_in_the_end); // the last image comes before this event
  send_event("finished", {{"edit", edit}});
  const std::lock_guard lock(mutex_);
  if (!options_.quiet && !finished_)
    print(fmt::format("finished: {}; waiting for edits, Ctrl+C ends", progress_));
  finished_ = true;
}

void LiveView::report_error(const std::string& line) {
  send_event("message", {{"level", "error"}, {"text", line}});
  const std::lock_guard lock(mutex_);
  clear_status();
  log_error(fmt::format("error: {}", line));
}

void LiveView::report_repaired() {
  const char* const line = "the scene can be read again, and is the one that is shown";
  send_event("message", {{"level", "note"}, {"text", line}});
  const std::lock_guard lock(mutex_);
  if (!options_.quiet)
    print(line);
}

nlohmann::ordered_json LiveView::image_event(const LiveImage& shown) const {
  nlohmann::ordered_json event{{"edit", shown.edit},
                               {"passes", shown.passes},
                               {"stage", shown.passes > 0 ? "pass" : "look"},
                               {"mixed", shown.mixed},
                               {"seconds", shown.seconds},
                               {"peak_memory", peak_memory()}};
  if (shown.record) {
    event["error"] = number(shown.record->error_estimate);
    event["error_low"] = number(shown.record->error_low);
    event["error_high"] = number(shown.record->error_high);
  }
  if (writer_)
    event["path"] = std::filesystem::absolute(options_.preview).string();
  return event;
}

void LiveView::show_status(const std::string& text) {
  if (!status_line_)
    return;
  const auto columns = static_cast<std::size_t>(terminal_columns(STDERR_FILENO));
  log_text("\r\033[K" + text.substr(0, columns > 1 ? columns - 1 : 1));
  status_shown_ = true;
}

void LiveView::clear_status() {
  if (status_shown_)
    log_text("\r\033[K");
  status_shown_ = false;
}

void LiveView::print(const std::string& line) {
  clear_status();
  log_line(line);
}

} // namespace vdbeam::cli
