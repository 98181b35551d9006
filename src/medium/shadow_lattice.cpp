#include "medium/shadow_lattice.h"

#include "math/sampling.h"
#include "medium/depth_profile.h"
#include "medium/nest_bounds.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

constexpr int fewest_steps = 8, most_steps = 192; ///< along the longest edge of the lattice

/// The box as its corners lie along the axes.
Boxf box_along(const std::array<Vec3f, 3>& axes, const Boxf& box) {
  Boxf result;
  for (int i = 0; i < 8; ++i) {
    const Vec3f p = box.corner(i);
    result.extend({dot(p, axes[0]), dot(p, axes[1]), dot(p, axes[2])});
  }
  return result;
}

} // namespace

ShadowLattice::ShadowLattice(const Medium& medium, const Vec3f& towards, double rays)
    : ShadowLattice(medium, medium.bounds, towards, rays) {
  for (const std::vector<std::size_t>& nest : medium.nests)
    finer_.push_back(ShadowLattice(medium, nest_bounds(medium, nest), towards, rays));
}

ShadowLattice::ShadowLattice(const Medium& medium, const Boxf& bounds, const Vec3f& towards,
                             double rays) {
  place(bounds, towards, rays);
  to_edge_ = std::max(0.0f, origin_.z - box_along(axes_, medium.bounds).lower.z);
  depths_.resize(static_cast<std::size_t>(counts_.x) * counts_.y * counts_.z);
  tbb::parallel_for(0, counts_.x * counts_.y, [&](int column) { trace_column(medium, column); });
}

std::uint64_t ShadowLattice::bytes(const Boxf& bounds, const Vec3f& towards, double rays) {
  ShadowLattice lattice;
  lattice.place(bounds, towards, rays);
  const Vec3<std::uint64_t> n(lattice.counts_);
  return n.x * n.y * n.z * sizeof(float);
}

void ShadowLattice::place(const Boxf& bounds, const Vec3f& towards, double rays) {
  axes_[2] = -towards;
  orthonormal_frame(axes_[2], axes_[0], axes_[1]);
  const Boxf box = box_along(axes_, bounds);
  const Vec3f extent = max(box.size(), Vec3f(1e-6f));
  const auto longest = static_cast<double>(max_component(extent)),
             area = static_cast<double>(extent.x) * static_cast<double>(extent.y);
  step_ = static_cast<float>(longest / std::clamp(std::floor(longest * std::sqrt(rays / area)),
                                                  double(fewest_steps), double(most_steps)));
  origin_ = box.lower;
  for (int a = 0; a < 3; ++a) {
    const int steps = std::max(1, static_cast<int>(std::lround(extent[a] / step_)));
    counts_[a] = steps + 1;
    spacing_[a] = extent[a] / static_cast<float>(steps);
  }
  step_ = std::min(spacing_.x, std::min(spacing_.y, spacing_.z));
}

/// Follows the light through the medium.
void ShadowLattice::trace_column(const Medium& medium, int column) {
  static thread_local DepthProfile profile;
  const Vec3f start = point({column / counts_.y, column % counts_.y, 0}) - axes_[2] * to_edge_;
  profile.build(medium, {{start, axes_[2]}}, std::exp(-opaque_optical_depth));
  float* depths = depths_.data() + static_cast<std::size_t>(column) * counts_.z;
  if (profile.empty())
    return;
  ProfileCursor cursor(profile);
  for (int z = 0; z < counts_.z; ++z) {
    cursor.move_to(to_edge_ + static_cast<float>(z) * spacing_.z);
    const Rgb tau = cursor.channels(medium);
    depths[z] = std::min(std::min(tau.x, tau.y), std::min(tau.z, opaque_optical_depth));
  }
}

Vec3f ShadowLattice::point(const Vec3<int>& index) const {
  const Vec3f along = origin_ + spacing_ * Vec3f(index);
  return axes_[0] * along.x + axes_[1] * along.y + axes_[2] * along.z;
}

const ShadowLattice& ShadowLattice::finest_at(const Vec3f& point) const {
  for (const ShadowLattice& lattice : finer_)
    if (lattice.holds(point))
      return lattice;
  return *this;
}

bool ShadowLattice::holds(const Vec3f& point) const {
  for (int a = 0; a < 3; ++a) {
    const float x = (dot(point, axes_[static_cast<std::size_t>(a)]) - origin_[a]) / spacing_[a];
    if (!(x >= 0 && x <= static_cast<float>(counts_[a] - 1)))
      return false;
  }
  return true;
}

float ShadowLattice::own_depth(const Vec3f& point) const {
  const std::size_t strides[3] = {static_cast<std::size_t>(counts_.y) * counts_.z,
                                  static_cast<std::size_t>(counts_.z), 1};
  std::size_t corner = 0;
  Vec3f f;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const float x = std::clamp((dot(point, axes_[a]) - origin_[axis]) / spacing_[axis], 0.0f,
                               static_cast<float>(counts_[axis] - 1));
    const int i = std::min(static_cast<int>(x), counts_[axis] - 2);
    f[axis] = x - static_cast<float>(i);
    corner += static_cast<std::size_t>(i) * strides[a];
  }
  const auto along_z = [&](std::size_t at) {
    return depths_[at] + f.z * (depths_[at + 1] - depths_[at]);
  };
  const auto along_y = [&](std::size_t at) {
    const float a = along_z(at);
    return a + f.y * (along_z(at + strides[1]) - a);
  };
  const float a = along_y(corner);
  return a + f.x * (along_y(corner + strides[0]) - a);
}

} // namespace vdbeam
