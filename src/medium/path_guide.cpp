#include "medium/path_guide.h"

#include "medium/nest_bounds.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

constexpr int most_blocks = 64; ///< along an axis

} // namespace

MediumBlocks::Lattice::Lattice(const Boxf& box, float finest, std::size_t first_block)
    : lower(box.lower), first(first_block) {
  const Vec3f size = max(box.size(), Vec3f(0));
  const float longest = max_component(size);
  const float width = std::max(longest / most_blocks, std::min(finest, longest));
  for (int a = 0; a < 3; ++a) {
    counts[a] = std::clamp(static_cast<int>(std::lround(size[a] / width)), 1, most_blocks);
    per_unit[a] = size[a] > 0 ? static_cast<float>(counts[a]) / size[a] : 0;
  }
}

MediumBlocks::MediumBlocks(const Medium& medium) {
  const auto add = [&](const Boxf& box, float finest) {
    lattices_.emplace_back(box, finest, lattices_.empty() ? 0 : size());
  };
  const auto width_of_cell = [](const Volume& volume) { return cell_width * volume.voxel_size; };
  for (const std::vector<std::size_t>& nest : medium.nests) {
    float finest = infinity;
    for (const std::size_t v : nest)
      finest = std::min(finest, width_of_cell(medium.volumes[v]));
    add(nest_bounds(medium, nest), finest);
  }
  float finest = infinity;
  for (const Volume& volume : medium.volumes)
    finest = std::min(finest, width_of_cell(volume));
  add(medium.bounds, finest);
}

Vec3f MediumBlocks::point(std::size_t lattice, const Vec3<int>& block, const Vec3f& within) const {
  const Lattice& of = lattices_[lattice];
  Vec3f result = of.lower;
  for (int a = 0; a < 3; ++a)
    if (of.per_unit[a] > 0)
      result[a] += (static_cast<float>(block[a]) + within[a]) / of.per_unit[a];
  return result;
}

void MediumBlocks::move(const Vec3f& by) {
  for (Lattice& lattice : lattices_)
    lattice.lower += by;
}

void MediumBlocks::scale(float factor) {
  for (Lattice& lattice : lattices_) {
    lattice.lower *= factor;
    lattice.per_unit *= 1 / factor;
  }
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
