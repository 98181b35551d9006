#pragma once

#include "batch/batch_summary.h"
#include "batch/note_book.h"
#include "console/display.h"
#include "console/progress.h"
#include "report/frame_files.h"
#include "scene/scene_document.h"
#include "vdbeam/render.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// How frames are rendered and written.
struct FrameOptions {
  FrameFiles files;
  double exposure = 0;
  std::string view = "filmic"; ///< view transform of the preview
  bool quiet = false;
  bool early_preview = false;          ///< the preview shows a quick look before the first pass
  std::optional<PassRange> pass_range; ///< the output is a partial image of these passes
  std::optional<PixelRegion> region;
  CheckpointSettings checkpoint;    ///< without its path
  SnapshotInterval snapshot;        ///< when snapshot and preview show the image so far
  std::shared_ptr<Display> display; ///< a viewer for the image so far, or null
  std::vector<std::string> parts;   ///< partial images to join instead of rendering; usually none
  std::string merged;               ///< what the passes of `pass_range` are merged into, or empty
};

/// A frame that is ready to be rendered.
struct LoadedFrame {
  Scene scene;
  std::string hash; ///< of the scene
  PreparedScenePtr prepared;
  double seconds_waited = 0; ///< for it to be read, once its turn had come

  int frame() const { return scene.frame.number; }
};

/// Renders one frame after the other to files.
class FrameRenderer {
public:
  explicit FrameRenderer(FrameOptions options) : options_(std::move(options)) {}

  /// Notes that several frames had, each with them.
  std::vector<std::string> repeated_notes() const { return notes_->repeated(); }

  /// Renders, with progress on stderr, until the scene's limit or a signal ends it. The image is
  /// written only when it is complete, else a checkpoint; without a whole pass it is a quick look,
  /// under its own name where the time limit ended it (and a FrameError says so), as a snapshot
  /// where a signal did. False where a signal ended it. Throws InputError and FrameError. `index`
  /// is the frame's place in the batch; `outcome` gets the error of the image.
  bool render_frame(const LoadedFrame& loaded, const std::string& title, FarmProgress& farm,
                    std::size_t index, FrameOutcome& outcome) const;

  /// Writes what stands for a frame whose volume is missing: black, without opacity.
  void write_black(const LoadedFrame& loaded) const;

  /// Joins the frame's partial images, which must be of this very scene, writes the image and
  /// removes them. Throws InputError and FrameError.
  void join_parts(const LoadedFrame& loaded) const;

  /// Why the frame's image on disk is not the finished one of this scene; empty where it is, or
  /// where the image is there that it was to be merged into.
  std::string why_unfinished(const LoadedFrame& loaded) const;

  /// Refuses a file that has the name of the frame's checkpoint and is none. Throws InputError.
  void check_side_files(int frame) const;

  /// Removes the frame's checkpoint, snapshot and parts, which a finished image has outlived; what
  /// only has the name of one stays.
  void remove_side_files(int frame) const;

  /// Removes what killed processes have left beside the outputs of a frame that is finished, beside
  /// which nothing is written that would.
  void remove_dead_files(int frame) const;

private:
  std::string path(Output output, int frame) const;
  std::string output(int frame) const { return path(Output::image, frame); }
  std::string region_text() const;
  std::string why_no_image(const std::string& path, const LoadedFrame& loaded) const;
  std::string why_no_part(const std::string& path, const LoadedFrame& loaded) const;
  /// Nothing where no preview is asked for.
  void write_preview(const RenderResult& result, int frame) const;
  void write_snapshot(const RenderResult& result, int frame) const;
  void write_so_far(const LoadedFrame& loaded, RenderResult& so_far, bool asked) const;
  void display(const LoadedFrame& loaded, const Image& image) const;
  RenderHooks picture_hooks(const LoadedFrame& loaded, Progress& progress) const;
  void write_files(const LoadedFrame& loaded, RenderResult& result) const;
  void add_metadata(Image& image, const LoadedFrame& loaded, const RenderResult& result) const;

  FrameOptions options_;
  std::shared_ptr<NoteBook> notes_ = std::make_shared<NoteBook>();
};

} // namespace vdbeam::cli
