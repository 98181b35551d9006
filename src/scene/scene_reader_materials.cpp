#include "geometry/gltf/gltf_camera.h"
#include "geometry/gltf/gltf_files.h"
#include "geometry/gltf/gltf_materials.h"
#include "scene/scene_reader.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace vdbeam {
/// Gives meshes of animated glTFs the time of the frame.
void SceneReader::set_file_times() {
  for (SurfaceSettings& surface : scene_.surfaces)
    if (surface.shape == SurfaceShape::file && is_animated_gltf(surface.file))
      surface.file_seconds = frame_.time / surface.file_fps;
}

/// Divides meshes that have the materials of their files: a surface for each material. The first
/// takes the mesh's number, the others come after all meshes of the scene file.
void SceneReader::use_file_materials() {
  const std::size_t count = scene_.surfaces.size();
  for (std::size_t i = 0; i < count; ++i) {
    const SurfaceSettings mesh = scene_.surfaces[i];
    if (!mesh.file_materials || mesh.shape != SurfaceShape::file || mesh.file.empty())
      continue;
    const std::string item = fmt::format("mesh.{}", i), key = item + ".file_materials";
    const auto set = locations_.lower_bound(item + ".material");
    if (set != locations_.end() && set->first.starts_with(item + ".material"))
      throw InputError(fmt::format("{}: {} excludes {}.material: write one or the other",
                                   locate(key), key, item));
    if (!is_gltf_file(mesh.file))
      throw InputError(one_line(
          fmt::format("{}: {} needs a .gltf or .glb file, got {}", locate(key), key, mesh.file)));
    GltfMaterials materials;
    try {
      materials = read_gltf_materials(mesh.file);
    } catch (const Error& problem) {
      throw InputError(
          fmt::format("{}: {}.file: {}", locate(item + ".file"), item, problem.what()));
    }
    for (const std::string& note : materials.notes)
      scene_.notes.push_back(one_line(fmt::format("{}: {}", mesh.file, note)));
    for (std::size_t part = 0; part < materials.used.size(); ++part) {
      SurfaceSettings& surface =
          part == 0 ? scene_.surfaces[i] : scene_.surfaces.emplace_back(mesh);
      surface.material = materials.used[part].settings;
      surface.part = materials.used[part].index;
      if (surface.name.empty()) // all parts are one object
        surface.name = fmt::format("mesh{}", i);
      if (!(surface.material.type == MaterialType::emissive))
        surface.group.clear();
    }
  }
}

} // namespace vdbeam
