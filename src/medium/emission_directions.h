#pragma once

#include "math/rng.h"
#include "volume/emitter.h"

#include <optional>
#include <vector>

namespace vdbeam {

/// Directions towards what glows in the medium, for next-event estimation by lines: a point is
/// drawn by how brightly the medium glows there, and stands for the whole line through it, along
/// which emission is then integrated (Simon, Hanika, Zirr and Dachsbacher, *Line Integration for
/// Rendering Heterogeneous Emissive Volumes*, 2017). The density of a direction is the integral
///   p(wi) = int p_V(x + t wi) t^2 dt
/// of the points' density p_V along the line, which has no pole where the light is near.
class EmissionDirections {
public:
  /// The emitters' fields are shared.
  explicit EmissionDirections(const std::vector<Emitter>& emitters);

  /// Nothing glows.
  bool empty() const { return cells_.empty(); }

  struct Sample {
    Vec3f wi;  ///< unit, from the point
    float pdf; ///< per solid angle
  };
  /// None where rounding leaves no direction.
  std::optional<Sample> sample(const Vec3f& point, Rng& rng) const;
  float pdf(const Vec3f& point, const Vec3f& wi) const;

private:
  struct Grid {
    Emitter emitter;
    std::vector<float> density; ///< p_V by cell, per render volume
  };
  struct Cell {
    std::size_t grid;
    Vec3<int> place;
    double end; ///< cumulative share
  };
  void add_cells(std::size_t grid);

  std::vector<Grid> grids_;
  std::vector<Cell> cells_;
};

} // namespace vdbeam
