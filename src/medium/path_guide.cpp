#include "medium/path_guide.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

constexpr int most_blocks = 64; ///< along an axis

} // namespace

MediumBlocks::MediumBlocks(const Medium& medium) : lower_(medium.bounds.lower) {
  const Vec3f size = max(medium.bounds.size(), Vec3f(0));
  float width = max_component(size) / most_blocks;
  float finest = infinity;
  for (const Volume& volume : medium.volumes)
    finest = std::min(finest, DensityField::cell_width * volume.voxel_size);
  width = std::max(width, std::min(finest, max_component(size)));
  for (int a = 0; a < 3; ++a) {
    counts_[a] = std::clamp(static_cast<int>(std::lround(size[a] / width)), 1, most_blocks);
    per_unit_[a] = size[a] > 0 ? static_cast<float>(counts_[a]) / size[a] : 0;
  }
}

Vec3f MediumBlocks::point(const Vec3<int>& block, const Vec3f& within) const {
  Vec3f result = lower_;
  for (int a = 0; a < 3; ++a)
    if (per_unit_[a] > 0)
      result[a] += (static_cast<float>(block[a]) + within[a]) / per_unit_[a];
  return result;
}

/// Flux is radiance times area: what a unit of it brings goes as the inverse.
PathGuide PathGuide::in_units(float factor) const {
  PathGuide guide = *this;
  guide.blocks.scale(factor);
  for (float& value : guide.importance)
    value /= factor * factor;
  return guide;
}

PathGuide::Emission PathGuide::emission(std::size_t l, double u) const {
  const std::vector<double>& c = distribution[l];
  const auto after = std::upper_bound(c.begin() + 1, c.end() - 1, u);
  const double begin = *(after - 1), share = *after - begin;
  const auto step = static_cast<double>(after - c.begin() - 1);
  const double place = (step + std::min((u - begin) / share, 1.0)) / steps;
  return {std::min(place, 1 - 0x1p-40), share * steps};
}

} // namespace vdbeam
