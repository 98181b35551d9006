#include "transport/path_guide.h"

#include <algorithm>

namespace vdbeam {

namespace {

constexpr int most_blocks = 64; ///< along an axis

} // namespace

CellBlocks::CellBlocks(const Volume& volume) {
  const Vec3<int>& cells = volume.field.cell_counts();
  while (max_component(cells) > most_blocks * width_)
    width_ *= 2;
  for (int a = 0; a < 3; ++a)
    counts_[a] = (cells[a] + width_ - 1) / width_;
  per_local_ = 1 / static_cast<float>(DensityField::cell_width * width_);
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
