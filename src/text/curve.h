#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// A piecewise linear curve of one or more values, as text: "0:0 0.5:0.2 1:1" or, with three values
/// each, "800:1,0.1,0 1500:1,0.8,0.3". Before its first and after its last point their values hold.
class Curve {
public:
  /// Throws InputError for a text that is none: fewer than two points, points that do not ascend,
  /// values that are not finite and at least 0, or not `values` of them.
  Curve(const std::string& text, std::size_t values);

  /// Value i at x.
  double at(double x, std::size_t i = 0) const;

private:
  std::vector<double> x_;
  std::vector<double> values_; ///< of each point, one after the other
  std::size_t count_;
};

/// What is wrong with such a text, or nothing; an empty one is no curve, which is right.
std::string why_no_curve(const std::string& text, std::size_t values);

} // namespace vdbeam
