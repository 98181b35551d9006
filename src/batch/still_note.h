#pragma once

#include "scene/scene_document.h"

#include <string>
#include <vector>

namespace vdbeam::cli {

/// The line for several frames of a scene in which nothing depends on the frame; empty where
/// something does, and for a single frame.
std::string still_note(const SceneDocument& document, const std::string& scene,
                       const std::vector<int>& frames);

} // namespace vdbeam::cli
