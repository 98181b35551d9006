#pragma once

#include "estimators/estimator.h"
#include "render/bias_probe.h"
#include "render/film_file.h"

#include <chrono>

namespace vdbeam {

/// The frame's passes, from the first to whatever ends it, with everything that may interrupt them:
/// signals, checkpoints, snapshots.
class PassLoop {
public:
  PassLoop(const Scene& scene, const RenderHooks& hooks, const PixelWindow& window,
           RenderResult& result);

  /// `probe` tells the bias; null where the estimator has none or nobody asks.
  void run(Estimator& estimator, BiasProbe* probe);

  const std::vector<std::size_t>& probe_pixels() const { return film_.probe_pixels(); }

private:
  using Clock = std::chrono::steady_clock;

  bool finished();
  bool stop(const char* reason);
  void resume();
  void record();
  PassRecord estimate_errors() const;
  void compare(PassRecord& record);
  void clamp(PassImage& pass);
  void serve_requests();
  template <class F>
  void attempt(F write);
  void write_checkpoint();
  void develop();
  FilmFileInfo file_info() const;
  bool stop_requested() const { return hooks_.stop && *hooks_.stop; }
  void note(const std::string& line);
  double seconds() const;
  int next_pass() const { return first_pass_ + film_.passes(); }

  const Scene& scene_;
  const RenderHooks& hooks_;
  PixelWindow window_;
  bool whole_;
  RenderResult& result_;
  Film film_;
  int first_pass_ = 0;
  /// Seconds count from here, so that what an estimator tries out before its first pass is in them.
  Clock::time_point start_ = Clock::now();
  double earlier_seconds_ = 0; ///< of the passes that came from a checkpoint
  std::uint64_t photons_before_ = 0;
  Clock::time_point last_attempt_; ///< to write a checkpoint
  int last_attempt_passes_ = 0, last_checkpoint_passes_ = 0;
  std::string pass_hash_; ///< empty where no film goes to disk
};

} // namespace vdbeam
