#pragma once

#include "vdbeam/vec.h"

#include <array>

namespace vdbeam {

/// An axis-aligned box; empty where a lower bound exceeds an upper one.
template <class T>
struct Box {
  Vec3<T> lower{T(1e30), T(1e30), T(1e30)}, upper{T(-1e30), T(-1e30), T(-1e30)};

  bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  void extend(const Vec3<T>& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  void extend(const Box& b) {
    lower = min(lower, b.lower);
    upper = max(upper, b.upper);
  }
  /// Corner `i` of 8: the bits x, y and z of its number choose the upper bound.
  Vec3<T> corner(int i) const {
    return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
  }
  Vec3<T> center() const { return (lower + upper) * T(0.5); }
  Vec3<T> size() const { return upper - lower; }
};
using Boxf = Box<float>;
using Boxd = Box<double>;

/// An affine map x -> M x + t, in double precision.
struct Affine {
  std::array<Vec3d, 3> rows{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}; ///< of M
  Vec3d translation;

  /// From the row-major 3 x 4 matrix [M t].
  static Affine from_matrix(const std::array<double, 12>& m) {
    Affine result;
    result.rows = {Vec3d{m[0], m[1], m[2]}, Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}};
    result.translation = {m[3], m[7], m[11]};
    return result;
  }

  Vec3d point(const Vec3d& p) const { return vector(p) + translation; }
  Vec3d vector(const Vec3d& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  double determinant() const { return dot(rows[0], cross(rows[1], rows[2])); }

  /// Bounds of a box that is mapped.
  Boxd bounds(const Boxd& box) const {
    Boxd result;
    for (int i = 0; i < 8; ++i)
      result.extend(point(box.corner(i)));
    return result;
  }
  /// The inverse map. Requires a non-zero determinant.
  Affine inverse() const {
    const double d = 1 / determinant();
    const Vec3d c0 = cross(rows[1], rows[2]) * d, c1 = cross(rows[2], rows[0]) * d,
                c2 = cross(rows[0], rows[1]) * d;
    Affine result;
    result.rows = {Vec3d{c0.x, c1.x, c2.x}, Vec3d{c0.y, c1.y, c2.y}, Vec3d{c0.z, c1.z, c2.z}};
    result.translation = -result.vector(translation);
    return result;
  }
  /// First `b`, then this.
  Affine after(const Affine& b) const {
    Affine result;
    for (int i = 0; i < 3; ++i)
      result.rows[i] = b.rows[0] * rows[i].x + b.rows[1] * rows[i].y + b.rows[2] * rows[i].z;
    result.translation = point(b.translation);
    return result;
  }
};

/// The same in single precision, for maps that are applied to many points.
struct Affinef {
  std::array<Vec3f, 3> rows{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
  Vec3f translation;

  Affinef() = default;
  explicit Affinef(const Affine& map)
      : rows{Vec3f(map.rows[0]), Vec3f(map.rows[1]), Vec3f(map.rows[2])},
        translation(map.translation) {}

  Vec3f point(const Vec3f& p) const { return vector(p) + translation; }
  Vec3f vector(const Vec3f& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
};

} // namespace vdbeam
