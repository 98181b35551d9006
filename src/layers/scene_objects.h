#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// The volumes and meshes of a scene by their names, for Cryptomatte. What has one name is one
/// object.
struct SceneObjects {
  std::vector<std::string> names; ///< in ascending order
  std::vector<std::size_t> of_volume, of_mesh;
};

/// Volumes and meshes without a name are called volume0, volume1, ..., mesh0, ...
SceneObjects scene_objects(const Scene& scene);

} // namespace vdbeam
