#pragma once

#include "report/frame_files.h"

#include <string>

namespace vdbeam {

/// A render may leave its checkpoint and snapshot beside its image, under names that nobody gave.
/// They are replaced and removed only where they are what such a render left; a link is never one.

/// Why the file must stay as it is: empty where there is none, where it is an empty file, and where
/// it is a `kind` (Output::checkpoint or Output::snapshot) that vdbeam wrote.
std::string why_not_replaceable(const std::string& path, Output kind);

/// Removes a checkpoint or snapshot that vdbeam wrote; anything else stays.
void remove_side_file(const std::string& path, Output kind);

/// True for an EXR file that holds a film: a partial image or a checkpoint.
bool holds_film(const std::string& path);

} // namespace vdbeam
