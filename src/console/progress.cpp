#include "console/progress.h"

#include "console/streams.h"
#include "console/terminal.h"
#include "text/printable.h"
#include "text/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace vdbeam::cli {
namespace {

constexpr std::chrono::milliseconds redraw_interval{100};
/// Erases from the beginning of the line to the end of the screen.
constexpr const char* erase_line = "\r\x1b[J";

} // namespace

void FarmProgress::frame_at(std::size_t index, double done) {
  const double percent = 100 * (static_cast<double>(index) + std::clamp(done, 0.0, 1.0)) /
                         static_cast<double>(frames_);
  constexpr double step = 0.1; // finer than anybody reads
  if (format_ == FarmFormat::plain || format_ == FarmFormat::json || percent < last_ + step)
    return;
  last_ = percent;
  if (format_ == FarmFormat::openjd)
    progress_text(fmt::format("openjd_progress: {:.1f}\n", percent));
  else
    progress_text(fmt::format("ALF_PROGRESS {:.0f}%\n", std::floor(percent)));
}

void FarmProgress::status(const std::string& text) const {
  if (format_ == FarmFormat::openjd)
    progress_text(fmt::format("openjd_status: {}\n", printable_line(text)));
}

void FarmProgress::failure(const std::string& text) const {
  if (format_ == FarmFormat::openjd)
    progress_text(fmt::format("openjd_fail: {}\n", printable_line(text)));
}

Progress::Progress(std::string title, const RenderSettings& settings, bool quiet)
    : title_(std::move(title)), settings_(settings), quiet_(quiet),
      terminal_(is_smart_terminal(STDERR_FILENO)) {}

double Progress::fraction(const PassRecord& record, const RenderSettings& settings) {
  double done = 0;
  if (settings.passes)
    done = std::max(done, static_cast<double>(record.pass) / *settings.passes);
  if (settings.time)
    done = std::max(done, record.seconds / *settings.time);
  // The error estimate falls as 1 / passes.
  if (settings.target_error && std::isfinite(record.error_estimate) && record.error_estimate > 0)
    done = std::max(done, *settings.target_error / record.error_estimate);
  return std::min(done, 1.0);
}

std::string Progress::describe(const PassRecord& record, const RenderSettings& settings) {
  std::string text =
      settings.passes
          ? fmt::format("{}/{}", record.pass,
                        count_text(static_cast<std::uint64_t>(*settings.passes), "pass"))
          : count_text(static_cast<std::uint64_t>(record.pass), "pass");
  text += ", " + format_duration(record.seconds);
  const double done = fraction(record, settings);
  if (done > 0 && done < 1)
    text += fmt::format(", {} left", format_duration(record.seconds * (1 - done) / done));
  if (std::isfinite(record.error_estimate))
    text += fmt::format(", error {:.2g}", record.error_estimate);
  return text;
}

std::string Progress::bar(const std::string& title, const PassRecord& record,
                          const RenderSettings& settings, int columns) {
  constexpr int longest_bar = 20, shortest_bar = 5;
  const std::string head = title.empty() ? "" : title + " ";
  std::string details = describe(record, settings);
  // A full line would already move the cursor to the next one.
  const auto room = [&] { return columns - 1 - static_cast<int>(head.size() + details.size()); };
  const int width = std::min(longest_bar, room() - 3);
  if (width >= shortest_bar) {
    const int filled = static_cast<int>(fraction(record, settings) * width);
    return fmt::format("{}[{:#<{}}{:.<{}}] {}", head, "", filled, "", width - filled, details);
  }
  while (room() < 0 && details.find(", ") != std::string::npos)
    details.erase(details.rfind(", "));
  return (head + details).substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
}

void Progress::line(const std::string& text) {
  if (quiet_)
    return;
  clear_bar();
  log("{}{}{}", title_, title_.empty() ? "" : ": ", text);
}

void Progress::clear_bar() {
  if (bar_shown_)
    log_text(erase_line);
  bar_shown_ = false;
}

void Progress::start(const std::string& text) {
  line(text);
  last_ = Clock::now();
  if (!quiet_ && !terminal_)
    heartbeat_.emplace(still_working("no pass yet"));
}

std::string Progress::still_working(const std::string& text) const {
  return fmt::format("{}{}{}, still working", title_, title_.empty() ? "" : ": ", text);
}

void Progress::pass(const PassRecord& record) {
  const auto now = Clock::now();
  if (heartbeat_)
    heartbeat_->set(still_working(describe(record, settings_)));
  const bool due =
      terminal_ ? !bar_shown_ || now - last_ >= redraw_interval : now - last_ >= heartbeat_interval;
  if (quiet_ || !due)
    return;
  last_ = now;
  if (!terminal_) {
    if (heartbeat_)
      heartbeat_->begin_anew();
    return line(describe(record, settings_));
  }
  // The cursor waits at the bar's beginning: a terminal that is made narrower wraps the bar and
  // keeps the cursor there, so all of it is still erased.
  log_text(fmt::format("{}{}\r", erase_line,
                       bar(title_, record, settings_, terminal_columns(STDERR_FILENO))));
  bar_shown_ = true;
}

void Progress::note(const std::string& text) {
  line("note: " + text);
}

void Progress::finish(const std::string& text) {
  heartbeat_.reset();
  line(text);
}

} // namespace vdbeam::cli
