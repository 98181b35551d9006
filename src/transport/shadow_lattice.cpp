#include "transport/shadow_lattice.h"

#include "transport/optical_depth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

constexpr int fewest_steps = 8, most_steps = 64; ///< along the longest edge of the medium

} // namespace

ShadowLattice::ShadowLattice(const Medium& medium, const Vec3f& towards, double rays) {
  const Vec3f extent = max(medium.bounds.size(), Vec3f(1e-6f));
  const double volume =
      static_cast<double>(extent.x) * static_cast<double>(extent.y) * static_cast<double>(extent.z);
  const auto longest = static_cast<double>(max_component(extent));
  step_ = static_cast<float>(longest / std::clamp(std::floor(longest * std::cbrt(rays / volume)),
                                                  double(fewest_steps), double(most_steps)));
  origin_ = medium.bounds.lower;
  for (int a = 0; a < 3; ++a) {
    const int steps = std::max(1, static_cast<int>(std::lround(extent[a] / step_)));
    counts_[a] = steps + 1;
    spacing_[a] = extent[a] / static_cast<float>(steps);
  }
  step_ = std::min(spacing_.x, std::min(spacing_.y, spacing_.z));
  depths_.resize(static_cast<std::size_t>(counts_.x) * counts_.y * counts_.z);
  tbb::parallel_for(0, counts_.x * counts_.y, [&](int row) {
    for (int z = 0; z < counts_.z; ++z) {
      const Vec3f point =
          origin_ + spacing_ * Vec3f(Vec3<int>{row / counts_.y, row % counts_.y, z});
      const float clear = max_component(exact_transmittance(medium, {{point, towards}}));
      depths_[static_cast<std::size_t>(row) * counts_.z + z] =
          clear > 0 ? std::min(-std::log(clear), opaque_optical_depth) : opaque_optical_depth;
    }
  });
}

float ShadowLattice::transmittance(const Vec3f& point) const {
  const std::size_t strides[3] = {static_cast<std::size_t>(counts_.y) * counts_.z,
                                  static_cast<std::size_t>(counts_.z), 1};
  std::size_t corner = 0;
  Vec3f f;
  for (int a = 0; a < 3; ++a) {
    const float x =
        std::clamp((point[a] - origin_[a]) / spacing_[a], 0.0f, static_cast<float>(counts_[a] - 1));
    const int i = std::min(static_cast<int>(x), counts_[a] - 2);
    f[a] = x - static_cast<float>(i);
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
  return std::exp(-(a + f.x * (along_y(corner + strides[0]) - a)));
}

} // namespace vdbeam
