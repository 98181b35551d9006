#pragma once

#include "film/film_file.h"
#include "machine/stopwatch.h"
#include "render/draft.h"
#include "render/shutter.h"

#include <chrono>

namespace vdbeam {

/// The frame's passes, from the first to whatever ends it, with everything that may interrupt them:
/// signals, checkpoints, snapshots.
class PassLoop {
public:
  PassLoop(const Scene& scene, const FrameSettings& frame, const RenderHooks& hooks,
           const PixelRegion& window, RenderResult& result);

  /// Before any pass: the film is to hold a deep picture too.
  void gather_deep(const DeepLayout& layout);

  /// The `stop` of the estimator's input.
  const StopToken& stop_token() const { return stop_; }
  /// Shows a quick look to the caller who asked for one, before there is any pass. `input` has the
  /// plan of the path estimator (plan_paths).
  void show_quick_look(EstimatorInput input);
  /// Renders a draft, shows it to the caller, and goes on with it where the time limit leaves no
  /// time for a pass; false where passes are to follow. `full` is the input of the estimators.
  bool draft(const PreparedScenePtr& prepared, const EstimatorInput& full);
  /// `quick_look` is the input of the quick look that stands for a picture without any pass and
  /// without a draft.
  void run(Shutter& shutter, const EstimatorInput& quick_look);

  const std::vector<std::size_t>& probe_pixels() const { return film_.probe_pixels(); }
  /// The number of the next pass, from 0.
  int next_pass() const { return first_pass_ + film_.passes(); }
  /// Reports a step of the next pass to the caller, or one outside of passes.
  void begin_step(RenderStep step) const;

private:
  using Clock = std::chrono::steady_clock;

  bool finished();
  bool stop(const char* reason);
  void resume();
  PassRange passes_asked_for() const;
  void record();
  PassRecord estimate_errors() const;
  void compare(PassRecord& record);
  void clamp(PassImage& pass);
  void serve_requests();
  bool snapshot_is_due() const;
  void take_snapshot();
  void attempt(const std::function<void()>& write);
  void write_checkpoint();
  Film make_film() const;
  Film make_film(int width, int height, std::optional<DeepFilm> deep = std::nullopt) const;
  DeepLayout window_layout() const;
  void replace_film();
  void develop();
  void finish_image();
  void place(Image& image) const;
  FilmFileInfo file_info() const;
  int least_passes() const;
  bool time_is_over() const;
  /// How well the picture is packed in the end: drafts and quick looks in little time.
  enum class Packing { quick, thorough };
  double limit_seconds(Packing packing = Packing::thorough) const;
  void set_deadline(Packing packing = Packing::thorough);
  void render_pass(Shutter& shutter);
  std::optional<Shutter::Renderer> renderer_of_pass(Shutter& shutter);
  void take_quick_look(EstimatorInput input, const StopToken& stop, PassImage& image);
  void take_picture(const std::function<PassImage(const PixelRegion&)>& image_of);
  void take_enlarged(const EstimatorInput& full);
  void take_draft(const EstimatorInput& full);
  void refine_draft(const PreparedScenePtr& prepared, const EstimatorInput& full);
  void show(const std::function<void()>& take);
  void take_early_picture(const EstimatorInput& quick_look);
  bool may_draft() const;
  int affordable_reduction() const;
  void note(const std::string& line);
  double seconds() const;

  const Scene& scene_;
  const FrameSettings& frame_;
  const RenderHooks& hooks_;
  PixelRegion window_;
  bool whole_;
  RenderResult& result_;
  /// Seconds count from here, so that the film's memory and what an estimator tries out before its
  /// first pass are in them.
  Clock::time_point start_ = Clock::now();
  const DeepLayout* deep_layout_ = nullptr; ///< null without a deep picture
  Film film_;
  int first_pass_ = 0;
  StopToken stop_;
  double earlier_seconds_ = 0;   ///< of the passes that came from a checkpoint
  double shortest_pass_ = 0;     ///< [s] of those rendered here; 0: there is none
  PassImage image_;              ///< of the pass in progress
  std::unique_ptr<Draft> draft_; ///< with a pass at least; null: there is none
  std::uint64_t photons_before_ = 0;
  Stopwatch since_attempt_; ///< to write a checkpoint
  Stopwatch since_snapshot_;
  int last_attempt_passes_ = 0, last_checkpoint_passes_ = 0, last_snapshot_passes_ = 0;
  /// Hashes of the scene as given, before an estimator was chosen; empty if no film is written to
  /// disk.
  std::string pass_hash_, scene_hash_;
};

} // namespace vdbeam
