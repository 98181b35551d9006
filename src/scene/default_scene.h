#pragma once

#include "vdb/vdb_reader.h"
#include "vdbeam/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// Settings that the user gave for the image of a bare VDB.
struct FramingWishes {
  std::optional<Vec3d> up; ///< unit
  std::optional<int> width, height;
  std::optional<std::string> grid;
};

/// A scene that shows a bare VDB: a camera that frames it, a sun and a sky, and an extinction that
/// shows its form. With a frame pattern in the name, the first, middle and last frame on disk
/// decide, so that the camera stands still. `notes` of the scene list the choices. Throws
/// InputError and FrameError as summarize_vdb.
Scene make_default_scene(const std::string& path, const FramingWishes& wishes);

/// The same from summaries that are already there, one list per file that decides.
Scene make_default_scene(const std::string& path,
                         const std::vector<std::vector<GridSummary>>& summaries,
                         const FramingWishes& wishes);

/// A commented scene file with the keys that matter first, or with `all_keys`; `file` is the
/// volume's path as it is to be written there.
std::string scene_text(const Scene& scene, const std::string& file, bool all_keys = false);

} // namespace vdbeam
