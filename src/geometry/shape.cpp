#include "geometry/shape.h"

#include "geometry/shape_math.h"
#include "geometry/simple_shapes.h"

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

/// How texture coordinates change along a direction.
using UvChange = std::pair<double, double>;

/// Directions of the picture where two directions of the surface have these changes; themselves
/// where the picture has no area.
UvDirections directions_of(const Vec3d& first, const Vec3d& second, const UvChange& of_first,
                           const UvChange& of_second) {
  const auto [u1, v1] = of_first;
  const auto [u2, v2] = of_second;
  const double determinant = u1 * v2 - u2 * v1;
  if (determinant == 0)
    return {first, second};
  return {(first * v2 - second * v1) / determinant, (second * u1 - first * u2) / determinant};
}

} // namespace

UvDirections Shape::uv_directions(std::size_t primitive, const Vec3d& point,
                                  const Vec3d& normal) const {
  // Differences over a short way. Where the picture's edges meet, a coordinate jumps by 1.
  constexpr double step = 1e-3;
  const Vec3d n = normalize(normal);
  const Vec3d first = normalize(cross(n, std::abs(n.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
  const Vec3d second = cross(n, first);
  const auto change = [&](const Vec3d& direction) {
    const Uv from = uv(primitive, point - direction * step),
             to = uv(primitive, point + direction * step);
    const double u{to.u - from.u}, v{to.v - from.v};
    return UvChange{u - std::round(u), v - std::round(v)};
  };
  return directions_of(first, second, change(first), change(second));
}

namespace {

/// The largest factor by which a map stretches a vector: the root of the largest eigenvalue of its
/// square (Smith 1961, for symmetric 3x3 matrices).
double most_stretch(const Affine& map) {
  double square[3][3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      square[i][j] = dot(map.rows[i], map.rows[j]);
  const double mean = (square[0][0] + square[1][1] + square[2][2]) / 3;
  double spread = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double d = square[i][j] - (i == j ? mean : 0);
      spread += d * d;
    }
  const double p = std::sqrt(spread / 6);
  if (!(p > 1e-12 * mean))
    return std::sqrt(mean);
  const auto b = [&](int i, int j) { return (square[i][j] - (i == j ? mean : 0)) / p; };
  const double half = 0.5 * (b(0, 0) * (b(1, 1) * b(2, 2) - b(1, 2) * b(2, 1)) -
                             b(0, 1) * (b(1, 0) * b(2, 2) - b(1, 2) * b(2, 0)) +
                             b(0, 2) * (b(1, 0) * b(2, 1) - b(1, 1) * b(2, 0)));
  return std::sqrt(mean + 2 * p * std::cos(std::acos(std::clamp(half, -1.0, 1.0)) / 3));
}

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
  double distance(std::size_t i, const Vec3d& point, const ShapePlace& place) const override {
    const Affine& map = place.to_render;
    return distance_to_triangle(point, map.point(vertex(i, 0)), map.point(vertex(i, 1)),
                                map.point(vertex(i, 2)));
  }
  double area() const override { return area_until_.back(); }
  double area_before(std::size_t i) const override { return i == 0 ? 0 : area_until_[i - 1]; }
  using Shape::sample;
  ShapePoint sample(std::size_t i, const AreaPlace& place) const override {
    const double root = std::sqrt(place.u), b1 = root * (1 - place.v), b2 = root * place.v;
    const Vec3d a = vertex(i, 0), e1 = vertex(i, 1) - a, e2 = vertex(i, 2) - a;
    return {a + e1 * b1 + e2 * b2, cross(e1, e2)};
  }
  AreaPlace place_of(std::size_t i, const Vec3d& point) const override {
    const auto [b1, b2] = barycentric(i, point);
    const double root = b1 + b2;
    return {root * root, root > 0 ? b2 / root : 0};
  }
  bool has_uvs() const override { return !mesh_.uvs.empty(); }
  Uv uv(std::size_t i, const Vec3d& point) const override {
    if (mesh_.uvs.empty())
      return {};
    const auto [b1, b2] = barycentric(i, point);
    const auto& [a, b, c] = mesh_.triangles[i];
    const Uv &first = mesh_.uvs[a], &second = mesh_.uvs[b], &third = mesh_.uvs[c];
    const auto u = static_cast<double>(first.u) * (1 - b1 - b2) +
                   static_cast<double>(second.u) * b1 + static_cast<double>(third.u) * b2;
    const auto v = static_cast<double>(first.v) * (1 - b1 - b2) +
                   static_cast<double>(second.v) * b1 + static_cast<double>(third.v) * b2;
    return {static_cast<float>(u), static_cast<float>(v)};
  }
  UvDirections uv_directions(std::size_t i, const Vec3d&, const Vec3d&) const override {
    const Vec3d e1 = vertex(i, 1) - vertex(i, 0), e2 = vertex(i, 2) - vertex(i, 0);
    if (mesh_.uvs.empty())
      return {e1, e2};
    const auto& [a, b, c] = mesh_.triangles[i];
    const auto difference = [&](std::uint32_t k) {
      return std::pair{static_cast<double>(mesh_.uvs[k].u) - static_cast<double>(mesh_.uvs[a].u),
                       static_cast<double>(mesh_.uvs[k].v) - static_cast<double>(mesh_.uvs[a].v)};
    };
    return directions_of(e1, e2, difference(b), difference(c));
  }
  bool is_smooth() const override { return !mesh_.normals.empty(); }
  Vec3d shading_normal(std::size_t i, const Vec3d& point) const override {
    const auto [b1, b2] = barycentric(i, point);
    const auto& [a, b, c] = mesh_.normals[i];
    const Vec3d mean = Vec3d(a) * (1 - b1 - b2) + Vec3d(b) * b1 + Vec3d(c) * b2;
    const Vec3d flat = cross(vertex(i, 1) - vertex(i, 0), vertex(i, 2) - vertex(i, 0));
    return dot(mean, flat) > 0 ? mean : flat;
  }
  std::size_t bytes() const override {
    return mesh_.bytes() + area_until_.size() * sizeof area_until_[0];
  }

private:
  std::size_t primitive_at(double share) const override {
    const auto found =
        std::upper_bound(area_until_.begin(), area_until_.end() - 1, share * area_until_.back());
    return static_cast<std::size_t>(found - area_until_.begin());
  }
  /// The shares of the second and third vertex in a point of a triangle.
  std::pair<double, double> barycentric(std::size_t i, const Vec3d& point) const {
    const Vec3d a = vertex(i, 0), e1 = vertex(i, 1) - a, e2 = vertex(i, 2) - a, p = point - a;
    const Vec3d n = cross(e1, e2);
    const double square = dot(n, n);
    return {dot(cross(p, e2), n) / square, dot(cross(e1, p), n) / square};
  }
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
  double distance(std::size_t, const Vec3d& point, const ShapePlace& place) const override {
    return std::abs(length(place.to_shape.point(point)) - 1) / place.most_shrink;
  }
  double area() const override { return 4 * pi_d; }
  using Shape::sample;
  ShapePoint sample(std::size_t, const AreaPlace& place) const override {
    const double z = 1 - 2 * place.u, r = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3d n{r * std::cos(2 * pi_d * place.v), r * std::sin(2 * pi_d * place.v), z};
    return {n, n};
  }
  AreaPlace place_of(std::size_t, const Vec3d& point) const override {
    return {(1 - normalize(point).z) / 2, turn(point)};
  }
  /// A picture of the globe: its middle faces -x, its right edge meets its left one at +x.
  Uv uv(std::size_t, const Vec3d& point) const override {
    const double z = std::clamp(normalize(point).z, -1.0, 1.0);
    return {static_cast<float>(turn(point)), static_cast<float>(1 - std::acos(z) / pi_d)};
  }
};

/// A part of the plane z = 0 with its front towards +z. The square around it shows the picture.
class FlatShape : public Shape {
public:
  std::size_t primitives() const override { return 1; }
  bool is_flat() const override { return true; }
  Boxd bounds(std::size_t) const override { return {{-1, -1, 0}, {1, 1, 0}}; }
  std::optional<ShapeHit> intersect(std::size_t, const Vec3d& origin, const Vec3d& direction,
                                    double t_begin, double t_end) const override {
    const double t = -origin.z / direction.z;
    if (!(t > t_begin && t < t_end) ||
        !holds(origin.x + direction.x * t, origin.y + direction.y * t))
      return std::nullopt;
    return ShapeHit{t, {0, 0, 1}};
  }
  Uv uv(std::size_t, const Vec3d& point) const override {
    return {static_cast<float>((point.x + 1) / 2), static_cast<float>((point.y + 1) / 2)};
  }
  UvDirections uv_directions(std::size_t, const Vec3d&, const Vec3d&) const override {
    return {{1, 0, 0}, {0, 1, 0}};
  }
};

class QuadShape final : public FlatShape {
public:
  double distance(std::size_t, const Vec3d& point, const ShapePlace& place) const override {
    const auto corner = [&](double x, double y) { return place.to_render.point({x, y, 0}); };
    const Vec3d a = corner(-1, -1), b = corner(1, 1);
    return std::min(distance_to_triangle(point, a, corner(1, -1), b),
                    distance_to_triangle(point, a, b, corner(-1, 1)));
  }
  double area() const override { return 4; }
  using Shape::sample;
  ShapePoint sample(std::size_t, const AreaPlace& place) const override {
    return {{2 * place.u - 1, 2 * place.v - 1, 0}, {0, 0, 1}};
  }
  AreaPlace place_of(std::size_t, const Vec3d& point) const override {
    return {(point.x + 1) / 2, (point.y + 1) / 2};
  }
  bool holds(double x, double y) const override { return std::abs(x) <= 1 && std::abs(y) <= 1; }
};

class DiskShape final : public FlatShape {
public:
  double distance(std::size_t, const Vec3d& point, const ShapePlace& place) const override {
    const Vec3d p = place.to_shape.point(point);
    const double beyond = std::max(0.0, std::hypot(p.x, p.y) - 1);
    const double to_plane = std::abs(p.z) / length(place.to_shape.rows[2]);
    return std::max(to_plane, std::hypot(beyond, p.z) / place.most_shrink);
  }
  double area() const override { return pi_d; }
  using Shape::sample;
  ShapePoint sample(std::size_t, const AreaPlace& place) const override {
    const double r = std::sqrt(place.u);
    return {{r * std::cos(2 * pi_d * place.v), r * std::sin(2 * pi_d * place.v), 0}, {0, 0, 1}};
  }
  AreaPlace place_of(std::size_t, const Vec3d& point) const override {
    return {point.x * point.x + point.y * point.y, turn(point)};
  }
  bool holds(double x, double y) const override { return x * x + y * y <= 1; }
};

} // namespace

ShapePlace ShapePlace::at(const Affine& to_render) {
  const Affine to_shape = to_render.inverse();
  return {to_render, to_shape, most_stretch(to_shape)};
}

std::shared_ptr<const Shape> make_mesh_shape(Mesh mesh) {
  return std::make_shared<MeshShape>(std::move(mesh));
}

std::shared_ptr<const Shape> make_simple_shape(SurfaceShape kind) {
  switch (kind) {
  case SurfaceShape::sphere:
    return std::make_shared<SphereShape>();
  case SurfaceShape::disk:
    return std::make_shared<DiskShape>();
  case SurfaceShape::plane:
    return make_plane_shape();
  case SurfaceShape::box:
    return make_box_shape();
  case SurfaceShape::cylinder:
    return make_cylinder_shape();
  case SurfaceShape::file:
  case SurfaceShape::quad:
    break;
  }
  return std::make_shared<QuadShape>();
}

} // namespace vdbeam
