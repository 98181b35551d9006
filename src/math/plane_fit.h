#pragma once

#include <array>

namespace vdbeam {

/// A plane fitted by weighted least squares to values at offsets (x, y) from a place: its value at
/// the place is the sum of `weight (row[0] + row[1] x + row[2] y)` times the values (local linear
/// regression; Fan and Gijbels, *Local Polynomial Modelling and Its Applications*, 1996).
struct PlaneFit {
  /// Steepness that is held against the fit, relative to its weights: where all places lie in a
  /// row, the plane across it would be undetermined.
  static constexpr double ridge = 1e-3;

  double one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0; ///< weighted sums

  void add(double weight, double dx, double dy) {
    one += weight;
    x += weight * dx;
    y += weight * dy;
    xx += weight * dx * dx;
    xy += weight * dx * dy;
    yy += weight * dy * dy;
  }
  /// The row of the normal equations' inverse that gives the plane's value at (0, 0).
  std::array<double, 3> row() const {
    const double a = xx + ridge * one, c = yy + ridge * one;
    const double minor = a * c - xy * xy, minor_x = x * c - xy * y, minor_y = x * xy - a * y;
    const double determinant = one * minor - x * minor_x + y * minor_y;
    return {minor / determinant, -minor_x / determinant, minor_y / determinant};
  }
};

} // namespace vdbeam
