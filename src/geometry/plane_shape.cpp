#include "geometry/simple_shapes.h"

#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

/// Least slope of a ray against the plane.
constexpr double least_slope = 1e-9;

/// A texture coordinate that single precision holds anywhere: the same under each way to go on
/// beyond the edges of the picture, whose longest period is two pictures.
float near_coordinate(double x) {
  constexpr double whole = 4096;
  return static_cast<float>(std::abs(x) <= whole ? x : std::fmod(x, 2.0) + std::copysign(2.0, x));
}

class PlaneShape final : public Shape {
public:
  std::size_t primitives() const override { return 1; }
  bool is_infinite() const override { return true; }
  bool is_flat() const override { return true; }
  bool holds(double, double) const override { return true; }
  /// Where the picture is shown first; the plane goes on.
  Boxd bounds(std::size_t) const override { return {{0, 0, 0}, {1, 1, 0}}; }
  std::optional<ShapeHit> intersect(std::size_t, const Vec3d& origin, const Vec3d& direction,
                                    double t_begin, double t_end) const override {
    if (!(std::abs(direction.z) > least_slope * std::hypot(direction.x, direction.y)))
      return std::nullopt;
    const double t = -origin.z / direction.z;
    if (!(t > t_begin && t < t_end))
      return std::nullopt;
    return ShapeHit{t, {0, 0, 1}};
  }
  double distance(std::size_t, const Vec3d& point, const ShapePlace& place) const override {
    return std::abs(place.to_shape.point(point).z) / length(place.to_shape.rows[2]);
  }
  /// No plane emits (validated), so none is drawn from by area.
  double area() const override { return std::numeric_limits<double>::infinity(); }
  using Shape::sample;
  ShapePoint sample(std::size_t, const AreaPlace&) const override { return {{}, {0, 0, 1}}; }
  AreaPlace place_of(std::size_t, const Vec3d&) const override { return {}; }
  Uv uv(std::size_t, const Vec3d& point) const override {
    return {near_coordinate(point.x), near_coordinate(point.y)};
  }
  UvDirections uv_directions(std::size_t, const Vec3d&, const Vec3d&) const override {
    return {{1, 0, 0}, {0, 1, 0}};
  }
};

} // namespace

std::shared_ptr<const Shape> make_plane_shape() {
  return std::make_shared<PlaneShape>();
}

} // namespace vdbeam
