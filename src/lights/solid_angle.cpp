#include "lights/solid_angle.h"

#include "math/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
/// Smaller ones are drawn by area, which is as good there.
constexpr double least_solid_angle = 1e-6;

/// A rectangle seen from a point, in the rectangle's own frame, and what its solid angle follows
/// from; the names are those of the paper.
struct SphericalRectangle {
  Vec3d x, y, z; ///< z away from the point
  double x0, y0, z0, x1, y1;
  double b0 = 0, b1 = 0, k = 0, solid_angle = 0;

  SphericalRectangle(const Rectangle& r, const Vec3d& point) {
    const double width = length(r.edge_x), height = length(r.edge_y);
    x = r.edge_x / width;
    y = r.edge_y / height;
    z = cross(x, y);
    const Vec3d to = r.corner - point;
    z0 = dot(to, z);
    if (z0 > 0) {
      z = -z;
      z0 = -z0;
    }
    x0 = dot(to, x);
    y0 = dot(to, y);
    x1 = x0 + width;
    y1 = y0 + height;
    if (!(z0 < -1e-9 * (width + height)))
      return;
    // The normals of the planes through the point and the sides.
    const Vec3d n[4] = {normalize(cross(Vec3d{x0, y0, z0}, Vec3d{x1, y0, z0})),
                        normalize(cross(Vec3d{x1, y0, z0}, Vec3d{x1, y1, z0})),
                        normalize(cross(Vec3d{x1, y1, z0}, Vec3d{x0, y1, z0})),
                        normalize(cross(Vec3d{x0, y1, z0}, Vec3d{x0, y0, z0}))};
    double angles[4];
    for (int i = 0; i < 4; ++i)
      angles[i] = std::acos(std::clamp(-dot(n[i], n[(i + 1) % 4]), -1.0, 1.0));
    b0 = n[0].z;
    b1 = n[2].z;
    k = two_pi - angles[2] - angles[3];
    solid_angle = angles[0] + angles[1] - k;
    if (!(solid_angle >= least_solid_angle))
      solid_angle = 0;
  }
};

} // namespace

double Ball::solid_angle(const Vec3d& point) const {
  const Vec3d to = center - point;
  const double sine2 = radius * radius / dot(to, to);
  if (!(sine2 < 1))
    return 0;
  // 1 - cos, which keeps its digits where the ball is far away.
  return two_pi * sine2 / (1 + std::sqrt(1 - sine2));
}

std::optional<SolidAnglePoint> Ball::sample(const Vec3d& point, double u, double v) const {
  const double whole = solid_angle(point);
  if (!(whole > 0))
    return std::nullopt;
  const Vec3d to = center - point;
  const double distance = length(to);
  const double rise = u * whole / two_pi; // 1 - cos
  const double cosine = 1 - rise, sine = std::sqrt(rise * (2 - rise));
  Vec3d tangent, bitangent;
  orthonormal_frame(to / distance, tangent, bitangent);
  const Vec3d wi = normalize(to / distance * cosine + tangent * (sine * std::cos(two_pi * v)) +
                             bitangent * (sine * std::sin(two_pi * v)));
  const double half_chord =
      std::sqrt(std::max(0.0, radius * radius - distance * distance * sine * sine));
  SolidAnglePoint found{wi, distance * cosine - half_chord, {}, 1 / whole};
  found.normal = normalize(wi * found.distance - to);
  return found;
}

double Rectangle::solid_angle(const Vec3d& point) const {
  return SphericalRectangle(*this, point).solid_angle;
}

std::optional<SolidAnglePoint> Rectangle::sample(const Vec3d& point, double u, double v) const {
  const SphericalRectangle r(*this, point);
  if (!(r.solid_angle > 0))
    return std::nullopt;
  const double angle = u * r.solid_angle + r.k;
  const double f = (std::cos(angle) * r.b0 - r.b1) / std::sin(angle);
  const double c = std::clamp(std::copysign(1.0, f) / std::sqrt(f * f + r.b0 * r.b0), -1.0, 1.0);
  const double x = std::clamp(-c * r.z0 / std::sqrt(std::max(1e-300, 1 - c * c)), r.x0, r.x1);
  const double d2 = x * x + r.z0 * r.z0;
  const double h0 = r.y0 / std::sqrt(d2 + r.y0 * r.y0), h1 = r.y1 / std::sqrt(d2 + r.y1 * r.y1);
  const double h = h0 + v * (h1 - h0);
  const double y = std::clamp(h * std::sqrt(d2 / std::max(1e-300, 1 - h * h)), r.y0, r.y1);
  const Vec3d to = r.x * x + r.y * y + r.z * r.z0;
  const double distance = length(to);
  return SolidAnglePoint{to / distance, distance, normal, 1 / r.solid_angle};
}

} // namespace vdbeam
