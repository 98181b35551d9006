#include "layers/scene_objects.h"

#include <fmt/format.h>

#include <algorithm>

namespace vdbeam {

SceneObjects scene_objects(const Scene& scene) {
  std::vector<std::string> volumes, meshes;
  for (const VolumeSettings& volume : scene.volumes)
    volumes.push_back(volume.name.empty() ? fmt::format("volume{}", volumes.size()) : volume.name);
  for (const SurfaceSettings& mesh : scene.surfaces)
    meshes.push_back(mesh.name.empty() ? fmt::format("mesh{}", meshes.size()) : mesh.name);
  SceneObjects objects;
  objects.names = volumes;
  objects.names.insert(objects.names.end(), meshes.begin(), meshes.end());
  std::sort(objects.names.begin(), objects.names.end());
  objects.names.erase(std::unique(objects.names.begin(), objects.names.end()), objects.names.end());
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::lower_bound(objects.names.begin(), objects.names.end(), name) - objects.names.begin());
  };
  for (const std::string& name : volumes)
    objects.of_volume.push_back(index_of(name));
  for (const std::string& name : meshes)
    objects.of_mesh.push_back(index_of(name));
  return objects;
}

} // namespace vdbeam
