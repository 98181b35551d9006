#include "batch/batch.h"

#include "batch/failure.h"
#include "batch/frame_events.h"
#include "console/events.h"
#include "console/heartbeat.h"
#include "console/signals.h"
#include "console/streams.h"
#include "console/terminal.h"
#include "machine/memory.h"
#include "machine/stop_reading.h"
#include "machine/stopwatch.h"
#include "machine/threads.h"
#include "plan/memory_check.h"
#include "prepare/prepared_scene.h"
#include "text/frame_range.h"
#include "text/printable.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <unistd.h>

namespace vdbeam::cli {
namespace {

/// Ends the program although a frame is still being read, which may take longer than a farm waits.
/// Reading leaves nothing behind.
[[noreturn]] void leave_now(int code) {
  send_end(code);
  std::fflush(nullptr);
  std::_Exit(code);
}

} // namespace

Batch::Batch(const SceneDocument& document, const std::string& scene, std::vector<int> frames,
             BatchOptions options)
    : document_(document), frames_(std::move(frames)), options_(std::move(options)),
      renderer_(options_.frame), farm_(options_.farm, frames_.size()),
      page_(options_.frame.files, options_.frame.exposure, options_.frame.view) {
  summary_.scene = scene;
  summary_.origin = this_batch();
  summary_.frames = frames_;
}

std::string Batch::title(std::size_t index) const {
  return frames_.size() == 1
             ? ""
             : fmt::format("frame {} ({}/{})", frames_[index], index + 1, frames_.size());
}

void Batch::say(const std::string& line) const {
  if (!options_.frame.quiet)
    log_text(printable_text(line) + '\n'); // a summary has several lines
}

/// Reads a frame's files. `before`: the frame before it, which is being rendered unless this one is
/// read `alone`.
void Batch::read(Loaded& loaded, const SharedLoaded& before, bool alone, Watch& watch) const {
  const Scene& scene = loaded.frame.scene;
  const std::uint64_t granted = granted_memory();
  const std::uint64_t beside = before && !alone ? std::min(before->bytes, granted) : 0;
  if (const std::optional<MemoryPlan> plan =
          plan_large_frame(scene, options_.frame.files.references(), granted - beside)) {
    check_planned_memory(scene, *plan, granted);
    loaded.bytes = std::max(plan->rendering, plan->writing);
    loaded.kept_bytes = plan->kept;
    const std::uint64_t reading = plan->reading - plan->program;
    loaded.deferred = before && !alone && beside + reading > granted;
    loaded.fits_after = !before || before->kept_bytes + plan->reading <= granted;
  } else {
    loaded.bytes = (granted - beside) / 2;
  }
  const PreparedScenePtr previous = before ? before->frame.prepared : nullptr;
  loaded.frame.prepared =
      loaded.deferred ? nullptr : prepare_scene(scene, previous, StopToken(&watch.give_up));
}

Batch::Loaded Batch::load(int frame, const SharedLoaded& before, bool alone, Watch& watch) const {
  Loaded loaded;
  if (before)
    loaded.frame.prepared = before->frame.prepared;
  const StopToken stop(&watch.give_up);
  const StopReading reading(stop);
  try {
    loaded.frame.scene = document_.scene_at(frame, options_.missing);
    if (!options_.frame.pass_range)
      watch.limit = preparation_limit(loaded.frame.scene.render);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(thread_count(loaded.frame.scene.render)));
    loaded.frame.hash = scene_hash(loaded.frame.scene);
    if (options_.skip_existing) {
      loaded.note = renderer_.why_unfinished(loaded.frame);
      loaded.skip = loaded.note.empty();
    }
    if (!loaded.skip && !loaded.frame.scene.black && options_.frame.parts.empty()) {
      renderer_.check_side_files(frame);
      read(loaded, before, alone, watch);
    }
  } catch (const InputError& error) {
    const std::string line = error.what();
    loaded.error =
        std::make_exception_ptr(InputError(document_.whose_file(loaded.frame.scene, line) + line));
  } catch (...) {
    loaded.error = std::current_exception();
  }
  if (loaded.error && watch.give_up)
    loaded.error = std::make_exception_ptr(preparation_failure(
        substitute_frame(options_.frame.files.output, frame), loaded.frame.scene.render));
  return loaded;
}

/// Reads on another thread: one thread beside a frame that is being rendered, all of them `alone`.
Batch::Reading Batch::load_aside(int frame, const SharedLoaded& before, bool alone) const {
  const auto watch = std::make_shared<Watch>();
  const auto task = std::make_shared<std::packaged_task<Loaded()>>(
      [this, frame, held = before, alone, watch]() mutable {
        const SharedLoaded previous = std::move(held); // TBB may keep the task for some time
        return load(frame, previous, alone, *watch);
      });
  Reading reading{task->get_future(), watch};
  // One thread waits here and takes no part in reading.
  tbb::task_arena arena(alone ? tbb::task_arena::automatic : 1, alone ? 1 : 0);
  arena.enqueue([task] { (*task)(); });
  return reading;
}

/// Ends the program, while a frame is being read, with summary and page of the frames before it.
void Batch::leave_interrupted() {
  int code = signal_exit_code();
  try {
    code = finish();
  } catch (const Error& error) {
    log_error(error.what());
  }
  leave_now(code);
}

/// Waits for a frame whose turn has come: from now on its time runs.
Batch::Loaded Batch::wait_for(Reading& reading) {
  const Stopwatch stopwatch;
  std::optional<Heartbeat> heartbeat;
  if (!options_.frame.quiet && !is_smart_terminal(STDERR_FILENO))
    heartbeat.emplace("reading the next frame, still working");
  while (reading.frame.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (stop_requested()) {
      say("interrupted while files were read");
      leave_interrupted();
    }
    if (stopwatch.seconds() > reading.watch->limit)
      reading.watch->give_up = true;
  }
  Loaded loaded = reading.frame.get();
  loaded.frame.seconds_waited = stopwatch.seconds();
  return loaded;
}

int Batch::run() {
  SharedLoaded loaded;
  page_.make_folder();
  send_event(
      "batch",
      {{"scene", summary_.scene}, {"frames", frames_}, {"output", options_.frame.files.output}});
  Reading next = load_aside(frames_[0], nullptr, true);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    send_reading(frames_[i]);
    Loaded read_ahead = wait_for(next);
    if (read_ahead.deferred) {
      if (!read_ahead.fits_after)
        loaded.reset();
      return_freed_memory(); // else it would count beside what is read now
      next = load_aside(frames_[i], loaded, true);
      const double waited = read_ahead.frame.seconds_waited;
      read_ahead = wait_for(next);
      read_ahead.frame.seconds_waited += waited;
    }
    loaded = std::make_shared<const Loaded>(std::move(read_ahead));
    if (i + 1 < frames_.size())
      next = load_aside(frames_[i + 1], loaded, false);
    const bool go_on = process(i, *loaded);
    if (go_on && !stop_requested())
      continue;
    const int code = finish();
    if (next.frame.valid() &&
        next.frame.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
      leave_now(code);
    return code;
  }
  return finish();
}

void Batch::fail(std::size_t index, const std::exception& error, FrameOutcome& outcome) {
  const Failure failure = describe(error);
  outcome.status = "failed";
  outcome.reason = failure.line;
  outcome.exit_code = static_cast<int>(failure.code);
  if (frames_.size() > 1) // else the program reports it itself
    send_frame_error(outcome.frame, failure);
  send_frame_end(outcome);
  farm_.failure(outcome.reason);
  farm_.frame_at(index, 1);
  record(outcome);
  if (frames_.size() > 1)
    log("{}: {}", title(index), outcome.reason);
}

/// Renders or skips one frame.
void Batch::handle(std::size_t index, const Loaded& loaded, FrameOutcome& outcome) {
  const std::string name = title(index);
  const auto announce = [&](const std::string& text) {
    say(fmt::format("{}{}{}: {}", name, name.empty() ? "" : ": ", outcome.output, text));
  };
  if (loaded.error)
    std::rethrow_exception(loaded.error);
  outcome.status = "done";
  if (loaded.skip) {
    outcome.status = "skipped";
    outcome.reason = "its finished image is there";
    renderer_.remove_side_files(outcome.frame);
    renderer_.remove_dead_files(outcome.frame);
    return announce(outcome.reason);
  }
  if (loaded.frame.scene.black) {
    outcome.reason = "a volume's file is missing; the image is black";
    renderer_.write_black(loaded.frame);
    return announce(outcome.reason);
  }
  if (!options_.frame.parts.empty()) {
    renderer_.join_parts(loaded.frame);
    return announce(fmt::format("joined from {} parts", options_.frame.parts.size()));
  }
  if (!loaded.note.empty() && loaded.note != "is not there")
    announce("rendered again: " + loaded.note);
  if (!renderer_.render_frame(loaded.frame, name, farm_, index, outcome))
    outcome.status = "interrupted";
}

/// Keeps an outcome and shows it on the page. A page that cannot be written now is written again at
/// the end of the batch.
void Batch::record(const FrameOutcome& outcome) {
  summary_.outcomes.push_back(outcome);
  summary_.origin.date = date_text();
  page_.add(outcome, outcome.output);
  try {
    page_.write({&summary_, 1}, summary_.outcomes.size() == frames_.size());
  } catch (const FrameError& error) {
    say(error.what());
  }
}

/// One frame and what became of it. False where the batch ends with it.
bool Batch::process(std::size_t index, const Loaded& loaded) {
  const Stopwatch watch;
  FrameOutcome outcome;
  outcome.frame = frames_[index];
  outcome.output = substitute_frame(options_.frame.files.output, outcome.frame);
  farm_.status(frames_.size() == 1 ? outcome.output : title(index));
  try {
    handle(index, loaded, outcome);
  } catch (const std::exception& error) {
    outcome.seconds = watch.seconds();
    fail(index, error, outcome);
    if (frames_.size() == 1) { // the program reports it itself
      finish();
      throw;
    }
    return !options_.stop_on_error;
  }
  outcome.seconds = watch.seconds();
  send_frame_end(outcome);
  record(outcome);
  if (outcome.status != "interrupted")
    farm_.frame_at(index, 1);
  return true;
}

int Batch::finish() {
  for (const std::string& line : renderer_.repeated_notes())
    say(line);
  if (frames_.size() > 1)
    say(summary_.text());
  if (const FrameFiles& files = options_.frame.files; !files.summary.empty())
    summary_.write(output_path(files, Output::summary, frames_.front()));
  page_.write({&summary_, 1}, true);
  if (!page_.problem().empty())
    throw FrameError(page_.problem());
  if (stop_requested() && summary_.outcomes.size() < frames_.size())
    return signal_exit_code();
  if (!summary_.with_status("interrupted").empty())
    return signal_exit_code();
  return summary_.with_status("failed").empty() ? 0 : static_cast<int>(ExitCode::frame_failed);
}

} // namespace vdbeam::cli
