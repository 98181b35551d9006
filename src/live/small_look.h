#pragma once

#include "vdbeam/render.h"

#include <atomic>
#include <optional>

namespace vdbeam {

/// Path traced images of scenes in few pixels: what can be seen of an edit soonest. They have the
/// layers of a scene's groups of lights. Each look has the pixels for which there was time in the
/// one before.
class SmallLooks {
public:
  /// Nothing for images that are small anyway, and where `stop` becomes true.
  std::optional<Image> take(const Scene& scene, const PreparedScenePtr& prepared,
                            const std::atomic<bool>& stop);

private:
  double pixels_ = 3000; ///< for which there is time
};

/// Interpolates between the middles of the pixels of a small image, to the size that `settings` ask
/// for.
Image enlarged(const Image& small, const ImageSettings& settings);

} // namespace vdbeam
