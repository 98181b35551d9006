#include "image/view_transform.h"

#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// A straight line up to `start`, then a hyperbola that nears 1 and begins with the line's slope;
/// it still separates five stops above white.
double roll_off(double x) {
  constexpr double start = 0.35;
  if (x <= start)
    return x;
  const double over = (x - start) / (1 - start);
  return start + (1 - start) * over / (1 + over);
}

/// The channels' own roll-off turns bright colours towards yellow, cyan and magenta; a roll-off of
/// the largest alone keeps their hue, but never lets them fade. Half of each does what film does:
/// orange fire goes through yellow to white.
Vec3d filmic(const Vec3d& radiance) {
  const double largest = std::max({radiance.x, radiance.y, radiance.z});
  if (!(largest > 0))
    return {};
  const double most = roll_off(largest);
  const Vec3d kept = radiance * (most / largest);
  const Vec3d separate(roll_off(radiance.x), roll_off(radiance.y), roll_off(radiance.z));
  return (kept + separate) * 0.5;
}

Vec3d clip(const Vec3d& radiance) {
  return min(radiance, Vec3d(1));
}

constexpr ViewTransform views[] = {
    {"filmic", "highlights roll off and fade to white", filmic},
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
