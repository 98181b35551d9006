#pragma once

#include "keys/scene_keys.h"

#include <filesystem>
#include <string>
#include <toml++/toml.h>
#include <vector>

namespace vdbeam {

/// A file that a scene names.
struct SceneFile {
  std::string key;      ///< "volume.0.file"
  std::string pattern;  ///< its path, with the placeholder of the frame number
  std::string location; ///< "scene.toml:12", or the option that gives it
  InputKind input;
};

/// Values of all keys of the kind `file` in a tree, in the order of the keys. `folder` is what
/// relative paths of the file are relative to.
std::vector<SceneFile> scene_files(const toml::table& root, const std::filesystem::path& folder);

/// Refuses what cannot be a file of this kind, before more than its first bytes are read: what is
/// not a regular file, is too large, or is a volume and does not begin like a VDB. An empty file
/// passes: its reader says that another program may still be writing it. Throws InputError.
void check_input(InputKind kind, const std::string& path);

/// Refuses a file that names others (the buffers of a glTF) which are no regular files. Throws
/// InputError.
void check_named_inputs(InputKind kind, const std::string& path);

/// The files that it names in turn.
std::vector<std::string> files_named_by(InputKind kind, const std::string& path);

} // namespace vdbeam
