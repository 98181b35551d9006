#pragma once

#include <cstdint>
#include <string>

namespace vdbeam {

/// Corners of faces of an OBJ file that name a normal (`f 1//7 ...`) which the file does not hold;
/// assimp leaves out all normals of a part with such a corner without a word.
std::uint64_t count_missing_normals(const std::string& obj_path);

} // namespace vdbeam
