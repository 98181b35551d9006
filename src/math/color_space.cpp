#include "vdbeam/color_space.h"

#include <cmath>

namespace vdbeam {
namespace {

struct Matrix {
  Vec3d rows[3];

  Vec3d apply(const Vec3d& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vec3d column(int i) const { return {rows[0][i], rows[1][i], rows[2][i]}; }
};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix m;
  for (auto& row : m.rows)
    for (int j = 0; j < 3; ++j)
      row[j] = dot(a.rows[&row - m.rows], b.column(j));
  return m;
}

Matrix inverse(const Matrix& m) {
  const Vec3d &a = m.rows[0], &b = m.rows[1], &c = m.rows[2];
  const Vec3d bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double determinant = dot(a, bc);
  Matrix result;
  for (int i = 0; i < 3; ++i)
    result.rows[i] = Vec3d{bc[i], ca[i], ab[i]} / determinant;
  return result;
}

/// X, Y and Z where Y is 1.
Vec3d xyz_of(double x, double y) {
  return {x / y, 1, (1 - x - y) / y};
}

/// SMPTE RP 177: primaries are scaled so that they add up to white.
Matrix rgb_to_xyz(const Chromaticities& c) {
  const Vec3d red = xyz_of(c.red_x, c.red_y), green = xyz_of(c.green_x, c.green_y),
              blue = xyz_of(c.blue_x, c.blue_y);
  Matrix primaries;
  for (int i = 0; i < 3; ++i)
    primaries.rows[i] = {red[i], green[i], blue[i]};
  const Vec3d scale = inverse(primaries).apply(xyz_of(c.white_x, c.white_y));
  for (Vec3d& row : primaries.rows)
    row *= scale;
  return primaries;
}

/// XYZ under one white to XYZ under another.
Matrix adaptation(const Vec3d& from, const Vec3d& to) {
  const Matrix cones{
      {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
  const Vec3d ratio = cones.apply(to) / cones.apply(from);
  Matrix scaled = cones;
  for (int i = 0; i < 3; ++i)
    scaled.rows[i] *= ratio[i];
  return product(inverse(cones), scaled);
}

} // namespace

bool Chromaticities::is_near(const Chromaticities& other) const {
  constexpr double near = 5e-4;
  const double pairs[][2] = {{red_x, other.red_x},     {red_y, other.red_y},
                             {green_x, other.green_x}, {green_y, other.green_y},
                             {blue_x, other.blue_x},   {blue_y, other.blue_y},
                             {white_x, other.white_x}, {white_y, other.white_y}};
  for (const auto& [a, b] : pairs)
    if (!(std::abs(a - b) < near))
      return false;
  return true;
}

Chromaticities chromaticities_of(ColorSpace space) {
  switch (space) {
  case ColorSpace::rec2020:
    return {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290};
  case ColorSpace::acescg:
    return {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};
  case ColorSpace::aces2065_1:
    return {0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767};
  default:
    return {};
  }
}

ColorMatrix rgb_matrix(const Chromaticities& from, const Chromaticities& to) {
  if (from.is_near(to))
    return {};
  const Matrix adapted =
      product(adaptation(xyz_of(from.white_x, from.white_y), xyz_of(to.white_x, to.white_y)),
              rgb_to_xyz(from));
  const Matrix m = product(inverse(rgb_to_xyz(to)), adapted);
  return {m.rows[0], m.rows[1], m.rows[2]};
}

} // namespace vdbeam
