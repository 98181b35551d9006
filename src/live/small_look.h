#pragma once

#include "vdbeam/render.h"

#include <atomic>
#include <optional>

namespace vdbeam {

/// A path traced image of a scene in few pixels, enlarged to the size of the scene's own: what can
/// be seen of an edit soonest. It has the layers of the scene's groups of lights. Nothing for
/// images that are small anyway, and where `stop` becomes true.
std::optional<Image> take_small_look(const Scene& scene, const PreparedScenePtr& prepared,
                                     const std::atomic<bool>& stop);

} // namespace vdbeam
