#pragma once

#include "lights/cone.h"

#include <functional>
#include <vector>

namespace vdbeam {

/// Draws directions of a cone nearly in proportion to a function of them: the cone is cut into
/// cells, a cell is drawn by the function's mean there, and a direction evenly in the cell. A tenth
/// of the directions are drawn evenly in the cone, so that what the cells' means miss is found too.
class DirectionTable {
public:
  /// `value` >= 0.
  DirectionTable(const Cone& cone, const std::function<double(const Vec3d& direction)>& value);

  struct Sample {
    Vec3d direction;
    double solid_angle; ///< reciprocal of the density [sr]
  };
  /// Both numbers are uniform in [0, 1); near numbers `place` give near directions.
  Sample sample(double place, double v) const;

private:
  static constexpr int rings = 128, sectors = 96;

  /// Where a ring begins: its share of the cone's solid angle. Equal steps of the angle, nearly.
  static double ring_begin(int ring) {
    const double x = static_cast<double>(ring) / rings;
    return x * x;
  }
  static double ring_share(int ring) { return ring_begin(ring + 1) - ring_begin(ring); }

  Cone cone_;
  std::vector<double> until_; ///< running sum of the cells' chances, ring by ring
};

} // namespace vdbeam
