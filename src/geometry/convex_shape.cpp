#include "geometry/shape_math.h"
#include "geometry/simple_shapes.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace vdbeam {
namespace {

constexpr double pi_d = std::numbers::pi;

/// Where a line enters and leaves a solid.
struct Chord {
  struct End {
    double t;
    std::size_t primitive;
    Vec3d normal;
  };
  End enter{-std::numeric_limits<double>::infinity(), 0, {}};
  End leave{std::numeric_limits<double>::infinity(), 0, {}};

  /// Cuts off what lies outside of a pair of sides; false where nothing is left.
  bool cut(const End& first, const End& last) {
    if (first.t > enter.t)
      enter = first;
    if (last.t < leave.t)
      leave = last;
    return enter.t <= leave.t;
  }
};

/// A convex solid. Each primitive asks for the chord through all of it: a line through an edge then
/// meets one of the two sides, whatever the rounding.
class ConvexShape : public Shape {
public:
  std::optional<ShapeHit> intersect(std::size_t primitive, const Vec3d& origin,
                                    const Vec3d& direction, double t_begin,
                                    double t_end) const override {
    const std::optional<Chord> found = chord(origin, direction);
    if (!found)
      return std::nullopt;
    for (const Chord::End& end : {found->enter, found->leave})
      if (end.primitive == primitive && end.t > t_begin && end.t < t_end)
        return ShapeHit{end.t, end.normal};
    return std::nullopt;
  }

protected:
  /// Cuts a chord by the slab from -1 to 1 along an axis, whose sides are two primitives.
  static bool cut_slab(Chord& chord, const Vec3d& origin, const Vec3d& direction, int axis,
                       std::size_t lower, std::size_t upper) {
    const double slope = direction[axis], from = origin[axis];
    if (slope == 0)
      return std::abs(from) <= 1;
    Vec3d normal{};
    normal[axis] = 1;
    const Chord::End low{(-1 - from) / slope, lower, -normal},
        high{(1 - from) / slope, upper, normal};
    return slope > 0 ? chord.cut(low, high) : chord.cut(high, low);
  }

private:
  virtual std::optional<Chord> chord(const Vec3d& origin, const Vec3d& direction) const = 0;
};

class BoxShape final : public ConvexShape {
public:
  std::size_t primitives() const override { return 6; }
  Boxd bounds(std::size_t i) const override {
    Boxd box{Vec3d(-1), Vec3d(1)};
    box.lower[axis(i)] = box.upper[axis(i)] = side(i);
    return box;
  }
  double distance(std::size_t i, const Vec3d& point, const ShapePlace& place) const override {
    const auto corner = [&](double u, double v) { return place.to_render.point(on(i, u, v)); };
    const Vec3d a = corner(-1, -1), b = corner(1, 1);
    return std::min(distance_to_triangle(point, a, corner(1, -1), b),
                    distance_to_triangle(point, a, b, corner(-1, 1)));
  }
  double area() const override { return 24; }
  double area_before(std::size_t i) const override { return 4.0 * static_cast<double>(i); }
  using Shape::sample;
  ShapePoint sample(std::size_t i, const AreaPlace& place) const override {
    Vec3d normal{};
    normal[axis(i)] = side(i);
    return {on(i, 2 * place.u - 1, 2 * place.v - 1), normal};
  }
  AreaPlace place_of(std::size_t i, const Vec3d& point) const override {
    return {(point[across(i)] * turned(i) + 1) / 2, (point[upward(i)] + 1) / 2};
  }
  Uv uv(std::size_t i, const Vec3d& point) const override {
    const AreaPlace place = place_of(i, point);
    return {static_cast<float>(place.u), static_cast<float>(place.v)};
  }

private:
  // Faces -x, +x, -y, +y, -z, +z. A viewer in front of one sees `across` to the right, times
  // `turned`, and `upward` up.
  static int axis(std::size_t i) { return static_cast<int>(i / 2); }
  static double side(std::size_t i) { return i % 2 == 0 ? -1 : 1; }
  static int across(std::size_t i) { return axis(i) == 0 ? 1 : 0; }
  static int upward(std::size_t i) { return axis(i) == 2 ? 1 : 2; }
  static double turned(std::size_t i) { return axis(i) == 1 ? -side(i) : side(i); }
  static Vec3d on(std::size_t i, double u, double v) {
    Vec3d point;
    point[axis(i)] = side(i);
    point[across(i)] = u * turned(i);
    point[upward(i)] = v;
    return point;
  }
  std::size_t primitive_at(double share) const override {
    return std::min<std::size_t>(5, static_cast<std::size_t>(share * 6));
  }
  std::optional<Chord> chord(const Vec3d& origin, const Vec3d& direction) const override {
    Chord found;
    for (int a = 0; a < 3; ++a)
      if (!cut_slab(found, origin, direction, a, static_cast<std::size_t>(2 * a),
                    static_cast<std::size_t>(2 * a + 1)))
        return std::nullopt;
    return found;
  }
};

class CylinderShape final : public ConvexShape {
public:
  std::size_t primitives() const override { return 3; }
  Boxd bounds(std::size_t i) const override {
    Boxd box{Vec3d(-1), Vec3d(1)};
    if (i != side)
      box.lower.z = box.upper.z = height(i);
    return box;
  }
  double distance(std::size_t i, const Vec3d& point, const ShapePlace& place) const override {
    const Vec3d p = place.to_shape.point(point);
    const double r = std::hypot(p.x, p.y);
    const double local = i == side ? std::hypot(r - 1, std::max(0.0, std::abs(p.z) - 1))
                                   : std::hypot(std::max(0.0, r - 1), p.z - height(i));
    return local / place.most_shrink;
  }
  double area() const override { return 6 * pi_d; }
  double area_before(std::size_t i) const override {
    return i == 0 ? 0 : (3 + static_cast<double>(i)) * pi_d;
  }
  using Shape::sample;
  ShapePoint sample(std::size_t i, const AreaPlace& place) const override {
    if (i == side) {
      const Vec3d normal{std::cos(2 * pi_d * place.u), std::sin(2 * pi_d * place.u), 0};
      return {normal + Vec3d{0, 0, 2 * place.v - 1}, normal};
    }
    const double r = std::sqrt(place.u), angle = 2 * pi_d * place.v;
    return {{r * std::cos(angle), r * std::sin(angle), height(i)}, {0, 0, height(i)}};
  }
  AreaPlace place_of(std::size_t i, const Vec3d& point) const override {
    if (i == side)
      return {turn(point), (point.z + 1) / 2};
    return {point.x * point.x + point.y * point.y, turn(point)};
  }
  Uv uv(std::size_t i, const Vec3d& point) const override {
    if (i == side)
      return {static_cast<float>(turn(point)), static_cast<float>((point.z + 1) / 2)};
    return {static_cast<float>((point.x * height(i) + 1) / 2),
            static_cast<float>((point.y + 1) / 2)};
  }

private:
  static constexpr std::size_t side = 0, bottom = 1, top = 2;
  static double height(std::size_t i) { return i == bottom ? -1 : 1; }
  std::size_t primitive_at(double share) const override {
    return share * 6 < 4 ? side : share * 6 < 5 ? bottom : top;
  }
  std::optional<Chord> chord(const Vec3d& origin, const Vec3d& direction) const override {
    Chord found;
    if (!cut_slab(found, origin, direction, 2, bottom, top))
      return std::nullopt;
    // From the point nearest to the axis, so that a far origin costs no digits.
    const Vec3d across{direction.x, direction.y, 0}, from{origin.x, origin.y, 0};
    const double square = dot(across, across);
    if (square == 0)
      return dot(from, from) <= 1 ? std::optional(found) : std::nullopt;
    const double middle = -dot(from, across) / square;
    const Vec3d nearest = from + across * middle;
    const double rest = 1 - dot(nearest, nearest);
    if (!(rest >= 0))
      return std::nullopt;
    const double half = std::sqrt(rest / square);
    const bool met = found.cut({middle - half, side, nearest - across * half},
                               {middle + half, side, nearest + across * half});
    return met ? std::optional(found) : std::nullopt;
  }
};

} // namespace

std::shared_ptr<const Shape> make_box_shape() {
  return std::make_shared<BoxShape>();
}

std::shared_ptr<const Shape> make_cylinder_shape() {
  return std::make_shared<CylinderShape>();
}

} // namespace vdbeam
