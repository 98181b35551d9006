#include "render/surface_files.h"

#include "geometry/mesh_size.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <set>

namespace vdbeam {
namespace {

/// What assimp takes in the process that reads a file, and with it a fifth as much in the renderer,
/// as measured on ten million triangles: 3.7 GB with 5 million vertices.
constexpr std::uint64_t bytes_per_vertex = 250, bytes_per_triangle = 250;
/// In the file's picture and in the texture made of it.
constexpr std::uint64_t bytes_per_texel = 24;

} // namespace

std::vector<SurfaceFile> surface_files(const Scene& scene) {
  std::vector<SurfaceFile> files;
  std::set<std::string> known;
  for (const SurfaceSettings& surface : scene.surfaces) {
    if (surface.shape == SurfaceShape::file && known.insert(surface.file).second) {
      const MeshSize size = foretell_mesh(surface.file);
      if (size.triangles > 0)
        files.push_back({surface.file, size.triangles, 0, 0,
                         size.vertices * bytes_per_vertex + size.triangles * bytes_per_triangle});
    }
    const std::string& texture = surface.material.texture;
    if (texture.empty() || !known.insert(texture).second)
      continue;
    try {
      const Image image = read_image(texture);
      files.push_back({texture, 0, image.width, image.height,
                       bytes_per_texel * static_cast<std::uint64_t>(image.width) *
                           static_cast<std::uint64_t>(image.height)});
    } catch (const Error&) {
    }
  }
  return files;
}

} // namespace vdbeam
