#include "image/view_transform.h"

#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// Middle gray of the scene, which keeps its value.
constexpr double middle_gray = 0.18;
/// Slope of shown light over the scene's in the deepest shadows, both as logarithms.
constexpr double toe_power = 1.45;

/// A toe, in which shadows darken by a power of themselves, and a shoulder, which nears 1: the
/// curve of Naka and Rushton. It has derivatives of every order above 0 and the slope 0 at 0.
double film_curve(double x) {
  static const double half = std::pow(middle_gray, toe_power) * (1 / middle_gray - 1);
  return 1 / (1 + half * std::pow(x, -toe_power));
}

/// The curve of each channel by itself turns bright colours towards yellow, cyan and magenta; that
/// of the largest alone keeps their hue, but never lets them fade. Half of each does what film
/// does: orange fire goes through yellow to white.
Vec3d filmic(const Vec3d& radiance) {
  const double largest = std::max({radiance.x, radiance.y, radiance.z});
  if (!(largest > 0))
    return {};
  const Vec3d separate(film_curve(radiance.x), film_curve(radiance.y), film_curve(radiance.z));
  const double most = std::max({separate.x, separate.y, separate.z}); // the curve of the largest
  const Vec3d kept = radiance * (most / largest);
  return (kept + separate) * 0.5;
}

Vec3d clip(const Vec3d& radiance) {
  return min(radiance, Vec3d(1));
}

constexpr ViewTransform views[] = {
    {"filmic", "shadows have a toe; highlights roll off and fade to white", filmic},
    {"srgb", "values above 1 are clipped", clip},
};

} // namespace

std::span<const ViewTransform> view_transforms() {
  return views;
}

const ViewTransform& view_transform(const std::string& name) {
  std::string known;
  for (const ViewTransform& view : views) {
    if (view.name == name)
      return view;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", view.name);
  }
  throw InputError(fmt::format("--view {}: unknown view; known are {}", name, known));
}

} // namespace vdbeam
