#pragma once

#include "math/stop_token.h"
#include "volume/density_field.h"

#include <functional>

namespace vdbeam {

/// Colours, RGB on the lattice of a density and where that is not empty: cells of 8^3 with a brick
/// of 9^3 values each, trilinear in between.
class ColorField {
public:
  /// `color` gives the colour at a lattice point, in local coordinates of the density `shape`; it
  /// is called from several threads. Throws Stopped.
  ColorField(const DensityField& shape, const std::function<Rgb(const Vec3d& local)>& color,
             const StopToken* stop = nullptr);

  /// At local coordinates of the density; white in empty cells and outside.
  Rgb sample(const Vec3f& local) const;
  std::size_t bytes() const;
  /// Bytes that the field of a density takes.
  static std::uint64_t bytes_of(const DensityField& shape);

private:
  Vec3<int> cell_counts_;
  std::vector<std::int32_t> cells_; ///< brick of each cell (x-major); -1: white
  std::vector<Rgb> bricks_;
};

} // namespace vdbeam
