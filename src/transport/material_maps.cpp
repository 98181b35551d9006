#include "transport/material_maps.h"

#include "materials/material_table.h"
#include "math/rng.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace vdbeam {
namespace {

/// Two numbers in [0, 1) that depend on a point alone.
std::pair<float, float> chances_at(const Vec3d& point) {
  std::uint64_t h = 0;
  for (const double x : {point.x, point.y, point.z})
    h = mix64(h + std::bit_cast<std::uint64_t>(x));
  return {static_cast<float>(h >> 40) * 0x1p-24f, static_cast<float>(h & 0xffffff) * 0x1p-24f};
}

} // namespace

MaterialMaps::MaterialMaps(const MaterialSettings& settings, double scale,
                           std::shared_ptr<const Texture> roughness,
                           std::shared_ptr<const Texture> metal)
    : roughness_texture_(std::move(roughness)), metal_texture_(std::move(metal)),
      roughness_(static_cast<float>(settings.roughness.value_or(1))),
      metal_(static_cast<float>(settings.metal)) {
  if (roughness_texture_) {
    const auto [least, most] = roughness_texture_->range(1);
    first_step_ = static_cast<int>(least * roughness_ * steps);
    count_ = static_cast<int>(std::ceil(most * roughness_ * steps)) - first_step_ + 1;
  }
  const int rough = std::max(1, count_);
  materials_.resize(static_cast<std::size_t>(rough) * (metal_texture_ ? 2 : 1));
  tbb::parallel_for(std::size_t{0}, materials_.size(), [&](std::size_t i) {
    MaterialSettings one = settings;
    const int step = static_cast<int>(i) % rough;
    if (roughness_texture_)
      one.roughness = (first_step_ + step) / static_cast<double>(steps);
    if (metal_texture_)
      one.metal = static_cast<int>(i) < rough ? 0 : 1;
    materials_[i] = make_material(one, scale);
  });
}

const Material& MaterialMaps::at(const SurfaceHit& hit) const {
  const auto [by_roughness, by_metal] = chances_at(hit.position);
  int step = 0;
  if (roughness_texture_) {
    const float place =
        roughness_texture_->at(hit.uv).y * roughness_ * steps - static_cast<float>(first_step_);
    step = std::clamp(static_cast<int>(place + by_roughness), 0, count_ - 1);
  }
  const bool metal = metal_texture_ && by_metal < metal_texture_->at(hit.uv).z * metal_;
  const std::size_t first = metal ? materials_.size() / 2 : 0;
  return *materials_[first + static_cast<std::size_t>(step)];
}

} // namespace vdbeam
