#pragma once

#include "console/heartbeat.h"
#include "vdbeam/render.h"

#include <chrono>
#include <optional>
#include <string>

namespace vdbeam::cli {

/// Progress lines on stdout for farm engines, or events for other programs (console/events).
enum class FarmFormat { plain, openjd, alf, json };

/// Prints how far a whole batch is, in one engine's words, each line flushed:
/// `openjd_progress: 42.5` (Open Job Description 2023-09) or `ALF_PROGRESS 42%` (Tractor,
/// Deadline); nothing for plain and json.
class FarmProgress {
public:
  FarmProgress(FarmFormat format, std::size_t frames) : format_(format), frames_(frames) {}

  /// `done` of the frame at `index` of the batch, in [0, 1].
  void frame_at(std::size_t index, double done);
  void status(const std::string& text) const;
  void failure(const std::string& text) const;

private:
  FarmFormat format_;
  std::size_t frames_;
  double last_ = -1; ///< percent
};

/// Reports the progress of a frame on stderr: a bar on a terminal; elsewhere, and under TERM=dumb,
/// a line at the start, one at the end, and at most one in ten seconds between them, each flushed.
class Progress {
public:
  /// `title` begins each line, e.g. "frame 7 (3/24)".
  Progress(std::string title, const RenderSettings& settings, bool quiet);

  void start(const std::string& text);
  void pass(const PassRecord& record);
  void note(const std::string& text);
  /// Takes the bar away and says how it went.
  void finish(const std::string& text);

  /// Share of the work that is done, by the limit that will be met first, in [0, 1].
  static double fraction(const PassRecord& record, const RenderSettings& settings);
  /// The same with a bar, on one line of a terminal of this many columns: a narrow one shows less.
  static std::string bar(const std::string& title, const PassRecord& record,
                         const RenderSettings& settings, int columns);
  /// "12/64 passes, 3.4s, 12.3s left, error 0.0123".
  static std::string describe(const PassRecord& record, const RenderSettings& settings);

private:
  using Clock = std::chrono::steady_clock;

  void line(const std::string& text);
  void clear_bar();
  std::string still_working(const std::string& text) const;

  std::string title_;
  RenderSettings settings_;
  bool quiet_, terminal_;
  bool bar_shown_ = false;
  Clock::time_point last_;
  std::optional<Heartbeat> heartbeat_; ///< where lines are wanted: for passes that take long
};

} // namespace vdbeam::cli
