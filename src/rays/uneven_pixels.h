#pragma once

#include "camera/camera.h"
#include "image/pass_image.h"

namespace vdbeam {

/// Whether one ray tells little of the pixel (x, y): the edge of the medium runs nearby, or that of
/// a lump before another. Only rays of the pixels around it in its tile are looked at, not its own:
/// if a pixel's own value decided how many rays share its weight, its mean would be biased.
/// `image` holds opacity and depth of the tile's pixels.
bool is_uneven(const PassImage& image, const Camera& camera, double world_scale, int x, int y);

} // namespace vdbeam
