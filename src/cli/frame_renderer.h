#pragma once

#include "scene/scene_document.h"
#include "vdbeam/render.h"

#include <string>

namespace vdbeam::cli {

/// Where a frame's results go; each may hold a frame number's place, and all but the first be
/// empty.
struct FrameFiles {
  std::string output, preview, report, reference;
};

/// Renders one frame after the other to files.
class FrameRenderer {
public:
  FrameRenderer(FrameFiles files, double exposure, bool quiet)
      : files_(std::move(files)), exposure_(exposure), quiet_(quiet) {}

  /// Renders, with progress on stderr, until the scene's limit or a signal ends it, and writes what
  /// there is. Throws InputError and FrameError.
  void render_frame(const SceneDocument& document, int frame, const std::string& title) const;

private:
  void write_files(const Scene& scene, RenderResult& result, int frame) const;

  FrameFiles files_;
  double exposure_;
  bool quiet_;
};

} // namespace vdbeam::cli
