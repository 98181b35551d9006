#pragma once

#include "scene/scene_document.h"

#include <string>
#include <vector>

namespace vdbeam::cli {

/// Checks the words of a `vdbeam render` as that command does before it renders: its options, one
/// by one and together, the scene, and that no output replaces an input. Throws InputError.
/// `document` is the scene that `scene_words` (SceneOptions::words) make; it is not opened again
/// where `words` say the same.
void check_render_command(const std::vector<std::string>& words, const SceneDocument& document,
                          const std::vector<std::string>& scene_words);

} // namespace vdbeam::cli
