#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Reads a scene file (TOML; docs/reference/scene.md) or makes a scene from a bare VDB. `overrides`
/// are "key.path=value" strings, applied last. The number of `frame` replaces ####, %04d and $F4 in
/// paths; animated keys are evaluated at its time. Throws InputError "file:line: key ..." if this
/// is not a valid scene.
Scene load_scene(const std::string& path, const FrameTime& frame = {},
                 const std::vector<std::string>& overrides = {});

/// The same from the text of a scene file. `path` stands for the file's in messages; relative paths
/// begin at its folder.
Scene parse_scene(const std::string& text, const std::string& path, const FrameTime& frame = {},
                  const std::vector<std::string>& overrides = {});

/// The text of a commented scene file for this volume (`vdbeam init`), with paths relative to
/// `folder` (empty: the current one). Throws InputError and FrameError for an unreadable VDB.
std::string scene_template(const std::string& vdb_path, const std::string& folder = "");

/// Checks ranges and consistency of a scene that a program has filled. Throws InputError.
void validate_scene(const Scene& scene);

/// 64-bit hash of everything that changes the image, as 16 hex digits: all keys except
/// render.threads, and the contents, not the names, of the files. Throws InputError for a file that
/// cannot be read.
std::string scene_hash(const Scene& scene);

/// The same without the stop rule (passes, time, target_error): passes with equal hashes can merge.
std::string pass_hash(const Scene& scene);

} // namespace vdbeam
