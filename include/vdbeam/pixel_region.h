#pragma once

namespace vdbeam {

/// Pixels x0 <= x < x1, y0 <= y < y1 of an image.
struct PixelRegion {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  bool operator==(const PixelRegion&) const = default;
};

} // namespace vdbeam
