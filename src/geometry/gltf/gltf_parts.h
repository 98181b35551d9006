#pragma once

#include <string>
#include <vector>

struct aiScene;

namespace vdbeam {

/// For each material of a scene that assimp has read from a glTF its index in the file; one beyond
/// the last for what triangles without a material have. assimp numbers materials as it comes across
/// them. Throws FrameError where they cannot be distinguished. For guarded processes.
std::vector<int> gltf_material_indices(const std::string& path, const aiScene& scene);

} // namespace vdbeam
