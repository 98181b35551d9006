#include "plan/surface_files.h"

#include "geometry/gltf/gltf_images.h"
#include "geometry/mesh_size.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace vdbeam {
namespace {

/// Memory of assimp in the process that reads a file, and with it a fifth as much in the renderer,
/// as measured on ten million triangles: 3.7 GB with 5 million vertices.
constexpr std::uint64_t bytes_per_vertex = 250, bytes_per_triangle = 250;
/// Memory of the normals at the corners of a triangle.
constexpr std::uint64_t bytes_of_normals = 36;
/// Memory per texel of the file's image and of the texture made from it.
constexpr std::uint64_t bytes_per_texel = 24;

/// Whether any surface with this file is shaded by normals: by those of the file, or of its
/// `smooth_angle`.
bool has_normals(const Scene& scene, const std::string& file, bool own) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const auto& surface) {
    return surface.shape == SurfaceShape::file && surface.file == file &&
           (surface.smooth_angle > 0 || (own && surface.file_normals));
  });
}

std::uint64_t mesh_bytes(const Scene& scene, const std::string& file, const MeshSize& size) {
  const std::uint64_t normals = has_normals(scene, file, size.normals) ? bytes_of_normals : 0;
  return size.vertices * bytes_per_vertex + size.triangles * (bytes_per_triangle + normals);
}

/// Adds the file of an image that can be read, once.
void add_texture(const TextureFile& texture, std::set<std::string>& known,
                 std::vector<SurfaceFile>& files) {
  if (texture.file.empty() ||
      !known.insert(fmt::format("{}|{}", texture.file, texture.image)).second)
    return;
  try {
    const Image image = read_picture({texture.file, texture.image, ""});
    files.push_back({texture.file, 0, image.width, image.height,
                     bytes_per_texel * static_cast<std::uint64_t>(image.width) *
                         static_cast<std::uint64_t>(image.height)});
  } catch (const Error&) {
  }
}

} // namespace

std::vector<SurfaceFile> surface_files(const Scene& scene) {
  std::vector<SurfaceFile> files;
  std::set<std::string> known;
  for (const SurfaceSettings& surface : scene.surfaces) {
    if (surface.shape == SurfaceShape::file && known.insert(surface.file).second) {
      const MeshSize size = foretell_mesh(surface.file);
      if (size.triangles > 0)
        files.push_back(
            {surface.file, size.triangles, 0, 0, mesh_bytes(scene, surface.file, size)});
    }
    for (const TextureUse use : texture_uses)
      add_texture(texture_file(surface.material, use), known, files);
  }
  return files;
}

} // namespace vdbeam
