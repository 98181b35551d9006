#pragma once

#include "vdbeam/deep_image.h"
#include "vdbeam/image.h"
#include "vdbeam/pass_record.h"
#include "vdbeam/picture_facts.h"
#include "vdbeam/pixel_region.h"
#include "vdbeam/render_plan.h"
#include "vdbeam/render_statistics.h"
#include "vdbeam/scene.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// Everything a render gives back.
struct RenderResult {
  Image image;                   ///< R, G, B, A and the AOVs
  std::optional<DeepImage> deep; ///< of the medium alone, where the scene asks for it
  std::vector<PassRecord> passes;
  RenderStatistics statistics;
  RenderPlan plan;
  std::vector<std::string> notes; ///< for the user: repairs, empty grids, choices made
  std::string stopped_by;         ///< "passes", "time", "target_error", "stop"
  PictureFacts picture;           ///< of a whole image; not of a quick look
  int resumed_passes = 0;         ///< passes that came from a checkpoint
  bool quick_look = false;        ///< no pass was finished; the image is for viewing only
  /// Drafts, for which the time limit left no time for a pass: the factor by which the resolution
  /// was reduced each way before the image was enlarged. Else 0.
  int draft = 0;
};

/// Passes first to last, both included, counted from 0.
struct PassRange {
  int first = 0, last = 0;
};

/// A file from which an interrupted render resumes, bit for bit (docs/how-to/sequences.md).
struct CheckpointSettings {
  std::string path;   ///< empty: none is written
  double seconds = 0; ///< interval between checkpoints [s]; 0: not by time
  int passes = 0;     ///< interval between checkpoints in passes; 0: not by passes
  bool resume = true; ///< begin with what is in the file, if it is of this scene
};

/// The part of a frame to render, and the files that passes go to.
struct FrameSettings {
  std::optional<PassRange> pass_range; ///< exactly these instead of those of the scene's stop rule
  std::optional<PixelRegion> region;   ///< only this part; its pixels are those of the whole image
  std::string partial; ///< where the passes go as a partial image, for merge_partials
  /// Written at intervals and when stopped, removed by nobody but the caller.
  CheckpointSettings checkpoint;
  /// Part of the stop rule's time that preparing the frame has taken already [s].
  double seconds_used = 0;
  /// The true image (R, G, B), for errors in the pass records; same size as the scene's.
  const Image* reference = nullptr;
  /// A second, independent one: removes the noise of both from the errors.
  const Image* second_reference = nullptr;
};

/// What a render is doing: preparing the frame, running the pilots, tracing a pass's photons,
/// rendering its pixels, developing the image.
enum class RenderStep { prepare, pilot, photons, pass, develop };

/// Interval at which the caller gets the image so far: of time or of passes; both 0: never. With
/// an interval of time, the first pass is shown in any case, and the last one never, since the
/// image itself follows.
struct SnapshotInterval {
  double seconds = 0;
  int passes = 0;

  bool wanted() const { return seconds > 0 || passes > 0; }
};

/// Callbacks and flags to observe and stop a render; all optional. They are called on the rendering
/// thread.
struct RenderHooks {
  /// After each pass.
  std::function<void(const PassRecord&, const RenderStatistics&)> on_pass;
  /// Before each step; `pass` is the number of the pass, from 1, or 0 outside of passes.
  std::function<void(RenderStep step, int pass)> on_step;
  /// A line for the user, as soon as it is known.
  std::function<void(const std::string&)> on_note;
  /// Ends the render soon when it becomes true; the pass in progress is lost, the first for a quick
  /// look.
  const std::atomic<bool>* stop = nullptr;
  /// A render that `stop` ends gives no image, and ends sooner.
  bool discards_when_stopped = false;
  /// When it becomes true, it is set to false and on_snapshot gets the image so far.
  std::atomic<bool>* snapshot = nullptr;
  /// When on_snapshot gets the image so far without being asked.
  SnapshotInterval snapshot_interval;
  /// `asked`: by `snapshot`, not by the interval.
  std::function<void(RenderResult&, bool asked)> on_snapshot;
  /// Gets a quick look before the first pass, which takes a part of the time of a pass.
  std::function<void(RenderResult&)> on_quick_look;
  /// Gives on_quick_look another one of more pixels, before the first pass of a large image.
  bool refines_quick_look = false;
};

class PreparedScene; ///< a scene's volumes and lights, read and made ready for rendering
using PreparedScenePtr = std::shared_ptr<const PreparedScene>;

/// Reads what `render` needs, and takes over from `previous` (or null) what is the same. May run
/// while `previous` is rendered. Throws InputError and FrameError, the latter also where `stop`
/// becomes true.
PreparedScenePtr prepare_scene(const Scene& scene, const PreparedScenePtr& previous = nullptr,
                               const std::atomic<bool>* stop = nullptr);

/// Renders one frame of a scene that is ready. Throws InputError and FrameError.
RenderResult render(const Scene& scene, const PreparedScenePtr& prepared,
                    const FrameSettings& frame = {}, const RenderHooks& hooks = {});

/// Prepares and renders one frame. Throws InputError and FrameError, the latter also where the time
/// or the caller ends it while it is prepared.
RenderResult render(const Scene& scene, const FrameSettings& frame = {},
                    const RenderHooks& hooks = {});

/// Settings of merge_partials.
struct MergeSettings {
  bool allow_gaps = false;   ///< merge although passes are missing
  std::optional<int> passes; ///< require exactly the passes 0 to passes - 1
  std::string partial;       ///< also write the merged passes as a partial image; empty: no
  std::string deep;          ///< also write the deep image, if the parts hold one; empty: no
};

/// Joins partial images of one scene, frame and region into the image of all their passes, bit for
/// bit that of an undivided render. Throws InputError for other files, passes that are there twice,
/// and passes that are missing.
Image merge_partials(const std::vector<std::string>& paths, const MergeSettings& settings = {});

/// The plan alone, from the scene and the grids' headers; reads no voxels.
RenderPlan make_plan(const Scene& scene);

/// The plan with what is chosen before the first pass, features and schedule: reads the scene's
/// files and runs the pilots, as a render does. Throws InputError and FrameError.
RenderPlan choose_plan(const Scene& scene);

} // namespace vdbeam
