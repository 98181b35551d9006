#include "lights/cone.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbeam {

Segment part_within(const Cone& cone, const Vec3d& tip, const Segment& segment) {
  if (segment.empty() || std::isinf(segment.t_end) || cone.one_minus_cos > 1)
    return segment;
  const Vec3d from_tip = Vec3d(segment.ray.origin) - tip, direction(segment.ray.direction);
  const double cosine = 1 - cone.one_minus_cos, along = dot(direction, cone.axis),
               height = dot(from_tip, cone.axis);
  const auto inside = [&](double t) {
    const Vec3d to = from_tip + direction * t;
    return dot(to, cone.axis) >= cosine * length(to);
  };
  // Where the ray meets the cone, or the one behind its tip: a t^2 + 2 b t + c = 0.
  const double a = along * along - cosine * cosine * dot(direction, direction),
               b = along * height - cosine * cosine * dot(direction, from_tip),
               c = height * height - cosine * cosine * dot(from_tip, from_tip),
               root = std::sqrt(std::max(0.0, b * b - a * c));
  const auto begin = static_cast<double>(segment.t_begin), end = static_cast<double>(segment.t_end);
  // Neither q / a nor c / q loses its digits.
  const double q = -(b + std::copysign(root, b));
  std::array<double, 4> cuts{begin, end, a != 0 ? q / a : begin, q != 0 ? c / q : begin};
  for (double& cut : cuts)
    cut = cut > begin ? std::min(cut, end) : begin;
  std::sort(cuts.begin(), cuts.end());
  Segment part{segment.ray, segment.t_end, segment.t_begin};
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    if (cuts[i] < cuts[i + 1] && inside(0.5 * (cuts[i] + cuts[i + 1]))) {
      part.t_begin = std::min(part.t_begin, static_cast<float>(cuts[i]));
      part.t_end = std::max(part.t_end, static_cast<float>(cuts[i + 1]));
    }
  return part;
}

} // namespace vdbeam
