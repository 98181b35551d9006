#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// The file named by a path that ends in a URI: this path if the file exists, else the path with
/// %20 and the like decoded.
std::string named_by_uri(const std::string& path);

/// The files that a .gltf file names (`uri`: buffers with its numbers, pictures), as paths, in
/// their order; not what it holds itself (`data:`). Empty for other files and for unreadable ones,
/// which reading the mesh or camera reports.
std::vector<std::string> gltf_files(const std::string& path);

/// The files that a file of meshes or cameras names: those of gltf_files, and the libraries of
/// materials at the head of an .obj file.
std::vector<std::string> files_named_by_model(const std::string& path);

/// Whether a glTF may have moving nodes. False for other files and for unreadable ones.
bool is_animated_gltf(const std::string& path);

/// Bytes of the files that a .gltf file names, as far as they are there. Throws InputError for what
/// is not a regular file or may not be read.
std::uint64_t bytes_of_gltf_files(const std::string& path);

/// Identifies a state of a file of meshes or cameras as file_identity does; a .gltf file together
/// with the files that it names.
std::string model_identity(const std::string& path);

} // namespace vdbeam
