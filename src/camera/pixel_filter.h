#pragma once

#include "vdbeam/camera_settings.h"

#include <vector>

namespace vdbeam {

/// Draws where a pixel's rays pass the picture, by the profile of its filter. Every ray counts for
/// its own pixel alone (filter importance sampling: Ernst, Stamminger, Greiner 2006), so pixels
/// stay independent and passes and merges exact.
class FilterSampler {
public:
  FilterSampler(PixelFilter filter, double width);

  bool operator==(const FilterSampler&) const = default;

  /// An offset from the pixel's left or upper edge [pixels] from a number in [0, 1); the pixel's
  /// centre lies at 0.5.
  double offset(double u) const;

  /// How far offsets reach beyond the pixel [pixels].
  double reach() const { return width_ > 1 ? (width_ - 1) / 2 : 0; }

  static double usual_width(PixelFilter filter) { return filter == PixelFilter::box ? 1 : 2; }

private:
  double width_;
  std::vector<double> cumulative_; ///< of the profile over the filter's width; empty: a box
};

} // namespace vdbeam
