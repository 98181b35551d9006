#pragma once

#include "geometry/gltf/gltf_images.h"
#include "vdbeam/surface_settings.h"

#include <string>
#include <vector>

namespace vdbeam {

/// A material of a glTF, as far as surfaces have such.
struct GltfMaterial {
  int index = 0; ///< by which triangles name it; one beyond the last: of those that name none
  MaterialSettings settings;
};

struct GltfMaterials {
  std::vector<GltfMaterial> used; ///< those that triangles have, by ascending index
  std::vector<std::string> notes; ///< for the user: what is left out
};

/// The materials of a .gltf or .glb file: base colour, opacity, metal, roughness, normals, clear
/// coat, index of refraction, transmission and emission of the metallic-roughness model, with their
/// textures; of the clear coat and of transmission only the factors. Something that reflects and
/// glows by a texture reflects only, which a note says. The file is parsed in a guarded child
/// process. Throws InputError for another file, FrameError for one that is damaged.
GltfMaterials read_gltf_materials(const std::string& path);

} // namespace vdbeam
