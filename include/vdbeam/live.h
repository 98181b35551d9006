#pragma once

#include "vdbeam/render.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// An image of a LiveSession.
struct LiveImage {
  Image image;        ///< R, G, B, A
  int edit = 0;       ///< number of the scene that it shows, from 1
  int passes = 0;     ///< 0: a quick look
  bool mixed = false; ///< from the images of single lights, which were rendered before the edit
  double seconds = 0; ///< since the scene was given
  /// Record of the last pass that was rendered, if there is one.
  std::optional<PassRecord> record;
};

/// What a LiveSession did with a scene that it was given.
struct LiveEdit {
  int edit = 0; ///< its number, from 1
  /// Keys that differ from the last scene, if any; of a table that was added or removed its name.
  std::vector<std::string> changed;
  bool mixed = false; ///< nothing is rendered anew: strengths of lights, or outputs, have changed
  /// Counts what was read and built for it; everything else was kept.
  std::uint64_t grids_read = 0, meshes_read = 0, trees_built = 0;
  /// What was kept of the scene before and why, a clause each.
  std::vector<std::string> kept;
};

/// Callbacks of a LiveSession, on threads of its own, never two at a time; all optional.
struct LiveHooks {
  std::function<void(LiveImage&)> on_image;     ///< may take the image away
  std::function<void(const LiveEdit&)> on_edit; ///< what it takes is known
  /// The scene cannot be rendered; std::current_exception() is the error.
  std::function<void(int edit, const std::string& line)> on_error;
  std::function<void(int edit)> on_finished; ///< the scene's stop rule is met
};

/// Renders the latest scene that it was given, until its stop rule is met or there is a newer one.
/// It keeps what does not change: volumes, meshes and the trees over them, photons where only the
/// camera moves. Every light has an image of its own, and all volumes that glow have one together,
/// so that an edit of strengths and colours of lights is shown at once and rendering goes on.
class LiveSession {
public:
  explicit LiveSession(LiveHooks hooks);
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  /// Ends the render in progress.
  ~LiveSession();

  /// Shows a scene instead of the last one. Returns at once, with the number of the edit.
  /// `files_changed`: files that it names have other contents than before, so that equal keys do
  /// not make an equal scene.
  int show(Scene scene, bool files_changed = false);
  /// Ends the render in progress, if there is one; the next scene that is shown begins another.
  void stop();

private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vdbeam
