#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// The file that is named by a path of which the end is a URI: this path where there is such a
/// file, else that in which %20 and the like are decoded.
std::string named_by_uri(const std::string& path);

/// The files that a .gltf file names (`uri`: buffers with its numbers, pictures), as paths, in
/// their order; not what it holds itself (`data:`). None of other files, and where it cannot be
/// read, which reading the mesh or camera will complain about.
std::vector<std::string> gltf_files(const std::string& path);

/// The files that a file of meshes or cameras names: those of gltf_files, and the libraries of
/// materials at the head of an .obj file.
std::vector<std::string> files_named_by_model(const std::string& path);

/// Bytes of the files that a .gltf file names, as far as they are there. Throws InputError for what
/// is not a regular file or may not be read.
std::uint64_t bytes_of_gltf_files(const std::string& path);

/// Tells one state of a file of meshes or cameras from another as file_identity does; a .gltf file
/// with those that it names.
std::string model_identity(const std::string& path);

} // namespace vdbeam
