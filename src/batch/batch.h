#pragma once

#include "batch/batch_summary.h"
#include "batch/frame_renderer.h"
#include "batch/page_writer.h"

#include <atomic>
#include <exception>
#include <future>
#include <limits>

namespace vdbeam::cli {

struct BatchOptions {
  FrameOptions frame;
  bool skip_existing = false; ///< leave frames alone whose finished image is there
  bool stop_on_error = false;
  MissingFile missing = MissingFile::error;
  FarmFormat farm = FarmFormat::plain;
};

/// Renders frames one after the other. While one is rendered, the next is read where both fit in
/// the memory that there may be; else it is read afterwards. At most two are in memory.
class Batch {
public:
  Batch(const SceneDocument& document, const std::string& scene, std::vector<int> frames,
        BatchOptions options);

  /// Returns the exit code. A failed frame does not stop the others unless asked to; a signal ends
  /// the batch. With a single frame its error is thrown.
  int run();

private:
  /// A frame that was read, or why it need not or cannot be rendered.
  struct Loaded {
    LoadedFrame frame;
    bool skip = false;
    std::string note; ///< why an image that is there is rendered again
    std::exception_ptr error;
    /// The most that it takes while it is rendered, and that its volumes keep after [bytes].
    std::uint64_t bytes = 0, kept_bytes = 0;
    bool deferred = false;  ///< not read, since it does not fit beside the frame before it
    bool fits_after = true; ///< beside what the frame before it keeps
  };
  using SharedLoaded = std::shared_ptr<const Loaded>;

  /// State shared by the thread that reads a frame and the one that waits for it.
  struct Watch {
    std::atomic<bool> give_up = false;
    std::atomic<double> limit = std::numeric_limits<double>::infinity(); ///< of the wait [seconds]
  };
  using SharedWatch = std::shared_ptr<Watch>;
  struct Reading {
    std::future<Loaded> frame;
    SharedWatch watch;
  };

  Loaded load(int frame, const SharedLoaded& before, bool alone, Watch& watch) const;
  void read(Loaded& loaded, const SharedLoaded& before, bool alone, Watch& watch) const;
  Reading load_aside(int frame, const SharedLoaded& before, bool alone) const;
  Loaded wait_for(Reading& reading);
  [[noreturn]] void leave_interrupted();
  void handle(std::size_t index, const Loaded& loaded, FrameOutcome& outcome);
  bool process(std::size_t index, const Loaded& loaded);
  void fail(std::size_t index, const std::exception& error, FrameOutcome& outcome);
  void record(const FrameOutcome& outcome);
  std::string title(std::size_t index) const;
  void say(const std::string& line) const;
  int finish();

  const SceneDocument& document_;
  std::vector<int> frames_;
  BatchOptions options_;
  FrameRenderer renderer_;
  FarmProgress farm_;
  BatchSummary summary_;
  PageWriter page_;
};

} // namespace vdbeam::cli
