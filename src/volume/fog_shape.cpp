#include "volume/fog_shape.h"

#include "volume/density_field.h"
#include "volume/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

/// Cells along the longest side of a shape: enough for what is decided cell by cell, as where
/// photons are stored.
constexpr int cells_along_box = 16, cells_along_sphere = 32;
/// Voxels over which a height fog falls to 1/e: its density between them is off by 8e-5 at most.
constexpr double voxels_per_scale_height = 32;
constexpr double voxels_per_feature = 4, voxels_along_noisy = 64, most_noisy_voxels = 1 << 24;

} // namespace

Boxd box_of(const VolumeSettings& volume) {
  return {volume.box_lower.value_or(Vec3d(-1)), volume.box_upper.value_or(Vec3d(1))};
}

FogShape::FogShape(const VolumeSettings& volume)
    : settings_(volume.fog), noise_(volume.noise), noisy_(volume.noise.amplitude > 0),
      box_(box_of(volume)) {
  if (settings_.shape == VolumeShape::height) {
    const double end = box_.lower.y - settings_.scale_height * std::log(settings_.least_density);
    box_.upper.y = std::min(box_.upper.y, end);
  }
  if (noisy_)
    place_noisy();
  else if (settings_.shape == VolumeShape::sphere)
    place_sphere();
  else if (settings_.shape == VolumeShape::height)
    place_layers();
  else
    place_box();
}

Vec3<int> FogShape::evenly(int most) const {
  const Vec3d size = box_.size();
  Vec3<int> cells;
  for (int a = 0; a < 3; ++a)
    cells[a] = std::max(1, static_cast<int>(std::lround(most * size[a] / max_component(size))));
  return cells;
}

void FogShape::place(const Boxd& box) {
  voxel_ = box.size() / (Vec3d(cells_) * double{cell_width});
  for (int a = 0; a < 3; ++a) {
    to_own_.rows[static_cast<std::size_t>(a)] = Vec3d();
    to_own_.rows[static_cast<std::size_t>(a)][a] = voxel_[a];
  }
  to_own_.translation = box.lower;
}

void FogShape::place_box() {
  cells_ = evenly(cells_along_box);
  place(box_);
}

void FogShape::place_layers() {
  cells_ = evenly(cells_along_box);
  const double voxels = voxels_per_scale_height * box_.size().y / settings_.scale_height;
  constexpr double most = 1 << 10;
  cells_.y = std::max(cells_.y, static_cast<int>(std::min(most, std::ceil(voxels / cell_width))));
  place(box_);
}

/// A voxel around it, since its surface rises over one.
void FogShape::place_sphere() {
  cells_ = Vec3<int>(cells_along_sphere);
  const double across = cells_along_sphere * cell_width;
  const Vec3d margin = box_.size() / (across - 2);
  place({box_.lower - margin, box_.upper + margin});
}

void FogShape::place_noisy() {
  const Vec3d reach(noise_.amplitude);
  Boxd box{box_.lower - reach, box_.upper + reach};
  const Vec3d size = box.size();
  const double feature = noise_.size / std::exp2(noise_.octaves - 1);
  double voxel = std::min(feature / voxels_per_feature, max_component(size) / voxels_along_noisy);
  if (settings_.shape == VolumeShape::height)
    voxel = std::min(voxel, settings_.scale_height / voxels_per_feature);
  const double least = std::cbrt(size.x * size.y * size.z / most_noisy_voxels);
  coarse_ = voxel < least;
  voxel = std::max(voxel, least);
  box.lower -= Vec3d(voxel);
  for (int a = 0; a < 3; ++a) {
    cells_[a] = static_cast<int>(std::ceil((size[a] / voxel + 2) / cell_width));
    box.upper[a] = box.lower[a] + voxel * cells_[a] * cell_width;
  }
  place(box);
}

FogShape::Cell FogShape::cell(const Vec3<int>& cell) const {
  if (!noisy_ && settings_.shape != VolumeShape::sphere)
    return is_layered() ? Cell::mixed : Cell::full;
  // All that its values can come from, and a voxel for faces that rise.
  const Vec3d reach = Vec3d(noise_.amplitude) + voxel_;
  const Vec3d corner = to_own_.point(Vec3d(cell) * double{cell_width});
  const Vec3d lower = corner - reach, upper = corner + voxel_ * double{cell_width} + reach;
  bool inside = true, outside = false;
  for (int a = 0; a < 3; ++a) {
    inside = inside && lower[a] >= box_.lower[a] && upper[a] <= box_.upper[a];
    outside = outside || upper[a] <= box_.lower[a] || lower[a] >= box_.upper[a];
  }
  if (outside || settings_.shape == VolumeShape::height)
    return outside ? Cell::empty : Cell::mixed;
  if (settings_.shape == VolumeShape::box)
    return inside ? Cell::full : Cell::mixed;
  const Vec3d center = box_.center(), radius = box_.size() / 2.0;
  Vec3d nearest, farthest;
  for (int a = 0; a < 3; ++a) {
    nearest[a] = (std::clamp(center[a], lower[a], upper[a]) - center[a]) / radius[a];
    farthest[a] = std::max(center[a] - lower[a], upper[a] - center[a]) / radius[a];
  }
  return dot(nearest, nearest) >= 1     ? Cell::empty
         : dot(farthest, farthest) <= 1 ? Cell::full
                                        : Cell::mixed;
}

double FogShape::value(const Vec3d& index) const {
  Vec3d own = to_own_.point(index);
  if (!noisy_ && settings_.shape == VolumeShape::height) {
    // The trapezoids between planes have the integral of the exponential: tanh(x) / x.
    const double x = voxel_.y / (2 * settings_.scale_height);
    return std::exp(-index.y * 2 * x) * (x > 0 ? std::tanh(x) / x : 1);
  }
  if (noisy_)
    own += noise_displacement(noise_, own);
  return density(own);
}

double FogShape::density(const Vec3d& own) const {
  switch (settings_.shape) {
  case VolumeShape::sphere:
    return in_sphere(own);
  case VolumeShape::height:
    return in_box(own) * std::exp(-std::max(0.0, own.y - box_.lower.y) / settings_.scale_height);
  default:
    return in_box(own);
  }
}

/// 1/2 at the surface, rising over a voxel across it.
double FogShape::in_sphere(const Vec3d& own) const {
  const Vec3d radius = box_.size() / 2.0, place = (own - box_.center()) / radius;
  const double distance = length(place);
  if (!(distance > 0))
    return 1;
  const double per_voxel = length(place * voxel_ / radius) / distance;
  return std::clamp(0.5 + (1 - distance) / per_voxel, 0.0, 1.0);
}

/// The same at faces.
double FogShape::in_box(const Vec3d& own) const {
  double share = 1;
  for (int a = 0; a < 3; ++a) {
    const double depth = std::min(own[a] - box_.lower[a], box_.upper[a] - own[a]);
    share *= std::clamp(0.5 + depth / voxel_[a], 0.0, 1.0);
  }
  return share;
}

double FogShape::integral() const {
  const Vec3d size = box_.size();
  const double volume = size.x * size.y * size.z;
  if (settings_.shape == VolumeShape::sphere)
    return volume * std::numbers::pi / 6;
  if (settings_.shape == VolumeShape::box)
    return volume;
  return size.x * size.z * settings_.scale_height * -std::expm1(-size.y / settings_.scale_height);
}

} // namespace vdbeam
