#pragma once

#include "camera/camera.h"
#include "image/pass_image.h"

namespace vdbeam {

/// Opacity and depth of the medium in a rectangle of pixels: as in PassImage, row by row.
struct SeenMedium {
  int x0, y0, width, height; ///< where the rectangle lies in the picture
  const float* opacity;
  const float* depth; ///< opacity times the mean distance [world]

  /// Index of pixel (x, y) of the image.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x - x0);
  }
};

/// Whether pixel (x, y) lies on an edge of opacity or depth, so that one ray does not represent it.
/// Only the surrounding pixels of its tile decide, not its own value: if a pixel's own value
/// decided how many rays share its weight, its mean would be biased. `seen` holds the tile's
/// pixels.
bool is_uneven(const SeenMedium& seen, const Camera& camera, double world_scale, int x, int y);

/// What a ray meets at its end.
struct EndOfRay {
  float light = 0;      ///< mean over channels
  bool surface = false; ///< the ray ends at one
};

/// The same for an edge of the light from the ends of rays, such as a surface's outline or the edge
/// of a shadow; `ends`: those of the tile's pixels. False where none of the pixels around shows a
/// surface.
bool is_unevenly_lit(const SeenMedium& seen, const EndOfRay* ends, int x, int y);

} // namespace vdbeam
