#pragma once

#include "geometry/surface_set.h"
#include "image/texture.h"

#include <memory>
#include <vector>

namespace vdbeam {

/// Draws points of a surface that shows a picture nearly in proportion to the light that it sends
/// out there: its primitives are cut into cells of equal area, and a cell is drawn by what it
/// shows.
class EmissionCells {
public:
  EmissionCells(std::shared_ptr<const SurfaceSet> surfaces, int surface, const Texture& texture);

  /// Its density is per area, render units. `place` finds the cell, u and v the point in it.
  SurfacePoint sample(double place, double u, double v) const;
  /// The density with which `sample` draws a point of the surface.
  float pdf(std::size_t primitive, const Vec3d& position, const Vec3f& normal) const;
  /// The picture's integral over the surface, render units.
  const Rgb& integral() const { return integral_; }

private:
  std::size_t cell_at(std::size_t primitive, const AreaPlace& place) const;
  /// Its density over that of points drawn uniformly on the shape.
  double density(std::size_t primitive, std::size_t cell) const;
  double share(std::size_t primitive) const;

  std::shared_ptr<const SurfaceSet> surfaces_;
  std::size_t surface_;
  std::vector<std::uint32_t> sides_; ///< cells along each side of a primitive
  std::vector<std::size_t> first_;   ///< cell of each primitive, and their number
  std::vector<double> until_;        ///< running sum of the cells' chances
  Rgb integral_;
};

} // namespace vdbeam
