#include "geometry/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {

Boxd Shape::bounds() const {
  Boxd box;
  for (std::size_t i = 0; i < primitives(); ++i)
    box.extend(bounds(i));
  return box;
}

namespace {

constexpr double pi_d = std::numbers::pi;

class MeshShape final : public Shape {
public:
  explicit MeshShape(Mesh mesh) : mesh_(std::move(mesh)) {
    area_until_.reserve(mesh_.triangles.size());
    double sum = 0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      sum += 0.5 * length(cross(vertex(i, 1) - vertex(i, 0), vertex(i, 2) - vertex(i, 0)));
      area_until_.push_back(sum);
    }
  }

  std::size_t primitives() const override { return mesh_.triangles.size(); }
  Boxd bounds(std::size_t i) const override {
    Boxd box;
    for (int k = 0; k < 3; ++k)
      box.extend(vertex(i, k));
    return box;
  }
  /// Moeller and Trumbore 1997.
  std::optional<ShapeHit> intersect(std::size_t i, const Vec3d& origin, const Vec3d& direction,
                                    double t_begin, double t_end) const override {
    const Vec3d a = vertex(i, 0), e1 = vertex(i, 1) - a, e2 = vertex(i, 2) - a;
    const Vec3d p = cross(direction, e2);
    const double determinant = dot(e1, p);
    if (determinant == 0)
      return std::nullopt;
    const double inverse = 1 / determinant;
    const Vec3d s = origin - a;
    const double u = dot(s, p) * inverse;
    if (!(u >= 0 && u <= 1))
      return std::nullopt;
    const Vec3d q = cross(s, e1);
    const double v = dot(direction, q) * inverse;
    if (!(v >= 0 && u + v <= 1))
      return std::nullopt;
    const double t = dot(e2, q) * inverse;
    if (!(t > t_begin && t < t_end))
      return std::nullopt;
    return ShapeHit{t, cross(e1, e2)};
  }
  double area() const override { return area_until_.back(); }
  ShapePoint sample(double u_primitive, double u, double v) const override {
    const auto found = std::upper_bound(area_until_.begin(), area_until_.end() - 1,
                                        u_primitive * area_until_.back());
    const auto i = static_cast<std::size_t>(found - area_until_.begin());
    const double root = std::sqrt(u), b1 = root * (1 - v), b2 = root * v;
    const Vec3d a = vertex(i, 0), e1 = vertex(i, 1) - a, e2 = vertex(i, 2) - a;
    return {a + e1 * b1 + e2 * b2, cross(e1, e2)};
  }
  std::size_t bytes() const override {
    return mesh_.bytes() + area_until_.size() * sizeof area_until_[0];
  }

private:
  Vec3d vertex(std::size_t triangle, int k) const {
    return Vec3d(mesh_.positions[mesh_.triangles[triangle][k]]);
  }

  Mesh mesh_;
  std::vector<double> area_until_; ///< running sum over the triangles
};

class SphereShape final : public Shape {
public:
  std::size_t primitives() const override { return 1; }
  Boxd bounds(std::size_t) const override { return {Vec3d(-1), Vec3d(1)}; }
  std::optional<ShapeHit> intersect(std::size_t, const Vec3d& origin, const Vec3d& direction,
                                    double t_begin, double t_end) const override {
    // From the point nearest to the centre, so that a far origin costs no digits.
    const double square = dot(direction, direction);
    const double middle = -dot(origin, direction) / square;
    const Vec3d nearest = origin + direction * middle;
    const double rest = 1 - dot(nearest, nearest);
    if (!(rest >= 0))
      return std::nullopt;
    const double half = std::sqrt(rest / square);
    for (const double t : {middle - half, middle + half})
      if (t > t_begin && t < t_end)
        return ShapeHit{t, nearest + direction * (t - middle)};
    return std::nullopt;
  }
  double area() const override { return 4 * pi_d; }
  ShapePoint sample(double, double u, double v) const override {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3d n{r * std::cos(2 * pi_d * v), r * std::sin(2 * pi_d * v), z};
    return {n, n};
  }
};

/// A part of the plane z = 0 with its front towards +z.
class FlatShape : public Shape {
public:
  std::size_t primitives() const override { return 1; }
  Boxd bounds(std::size_t) const override { return {{-1, -1, 0}, {1, 1, 0}}; }
  std::optional<ShapeHit> intersect(std::size_t, const Vec3d& origin, const Vec3d& direction,
                                    double t_begin, double t_end) const override {
    const double t = -origin.z / direction.z;
    if (!(t > t_begin && t < t_end) ||
        !holds(origin.x + direction.x * t, origin.y + direction.y * t))
      return std::nullopt;
    return ShapeHit{t, {0, 0, 1}};
  }

private:
  virtual bool holds(double x, double y) const = 0;
};

class QuadShape final : public FlatShape {
public:
  double area() const override { return 4; }
  ShapePoint sample(double, double u, double v) const override {
    return {{2 * u - 1, 2 * v - 1, 0}, {0, 0, 1}};
  }

private:
  bool holds(double x, double y) const override { return std::abs(x) <= 1 && std::abs(y) <= 1; }
};

class DiskShape final : public FlatShape {
public:
  double area() const override { return pi_d; }
  ShapePoint sample(double, double u, double v) const override {
    const double r = std::sqrt(u);
    return {{r * std::cos(2 * pi_d * v), r * std::sin(2 * pi_d * v), 0}, {0, 0, 1}};
  }

private:
  bool holds(double x, double y) const override { return x * x + y * y <= 1; }
};

} // namespace

std::shared_ptr<const Shape> make_mesh_shape(Mesh mesh) {
  return std::make_shared<MeshShape>(std::move(mesh));
}

std::shared_ptr<const Shape> make_simple_shape(SurfaceShape kind) {
  if (kind == SurfaceShape::sphere)
    return std::make_shared<SphereShape>();
  if (kind == SurfaceShape::disk)
    return std::make_shared<DiskShape>();
  return std::make_shared<QuadShape>();
}

} // namespace vdbeam
