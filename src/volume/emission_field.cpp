#include "volume/emission_field.h"

#include <tbb/parallel_for.h>

namespace vdbeam {

namespace {

/// Share of the brightest value below which emission is invisible beside it.
constexpr float darkest_share = 1e-8f;

} // namespace

std::uint64_t EmissionField::bytes_of(const DensityField& shape, bool uniform) {
  const Vec3<int>& n = shape.cell_counts();
  const std::size_t cells = static_cast<std::size_t>(n.x) * n.y * n.z;
  std::uint64_t bricks = 0;
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const std::int32_t entry = shape.cell(i, j, k);
        bricks += entry >= 0 || (entry != DensityField::empty_cell && !uniform) ? 1 : 0;
      }
  return cells * sizeof(std::int32_t) + bricks * DensityField::brick_size * sizeof(Rgb);
}

EmissionField::EmissionField(const DensityField& shape, const Law& law, bool uniform,
                             const StopToken* stop)
    : origin_(shape.origin()), cell_counts_(shape.cell_counts()) {
  if (shape.empty())
    return;
  number_cells(shape, uniform);
  tbb::parallel_for(0, cell_counts_.x, [&](int i) {
    for (int j = 0; j < cell_counts_.y; ++j)
      for (int k = 0; k < cell_counts_.z; ++k) {
        const std::int32_t entry = cell(i, j, k), source = shape.cell(i, j, k);
        if (entry < 0)
          continue;
        if (stop)
          stop->check();
        Rgb* brick = bricks_.data() + static_cast<std::size_t>(entry) * DensityField::brick_size;
        for (int x = 0; x < brick_width; ++x)
          for (int y = 0; y < brick_width; ++y)
            for (int z = 0; z < brick_width; ++z) {
              const int at = (x * brick_width + y) * brick_width + z;
              const float value =
                  source >= 0 ? shape.brick(source)[at] : shape.uniform_value(source);
              const Vec3<int> place{8 * i + x, 8 * j + y, 8 * k + z};
              brick[at] = value > 0 ? law(value, Vec3f(place)) : Rgb();
            }
      }
  });
  for (Rgb& value : uniform_values_)
    value = value.x > 0 ? law(value.x, {}) : Rgb();
  drop_dark_cells();
}

/// Numbers the bricks; uniform values are those of the shape until the law is applied.
void EmissionField::number_cells(const DensityField& shape, bool uniform) {
  cells_.assign(static_cast<std::size_t>(cell_counts_.x) * cell_counts_.y * cell_counts_.z,
                DensityField::empty_cell);
  std::int32_t bricks = 0, uniform_entries = 0;
  const auto visit = [&](const auto& body) {
    for (int i = 0; i < cell_counts_.x; ++i)
      for (int j = 0; j < cell_counts_.y; ++j)
        for (int k = 0; k < cell_counts_.z; ++k)
          if (const std::int32_t entry = shape.cell(i, j, k); entry != DensityField::empty_cell)
            body(cells_[cell_offset(i, j, k)], entry);
  };
  visit([&](std::int32_t& cell, std::int32_t entry) {
    const bool stays = entry < 0 && uniform;
    cell = stays ? entry : bricks++;
    uniform_entries =
        stays ? std::max(uniform_entries, DensityField::uniform_base - entry + 1) : uniform_entries;
  });
  bricks_.resize(static_cast<std::size_t>(bricks) * DensityField::brick_size);
  for (std::int32_t n = 0; n < uniform_entries; ++n)
    uniform_values_.emplace_back(shape.uniform_value(DensityField::uniform_base - n));
}

/// Empties the cells that send out next to nothing, closes the gaps between the bricks, and finds
/// the bounds of the rest.
void EmissionField::drop_dark_cells() {
  const auto brightest = [](const Rgb* values, std::size_t count) {
    float most = 0;
    for (std::size_t i = 0; i < count; ++i)
      most = std::max(most, max_component(values[i]));
    return most;
  };
  std::vector<float> maxima(brick_count());
  tbb::parallel_for(std::size_t{0}, maxima.size(), [&](std::size_t b) {
    maxima[b] = brightest(brick(static_cast<std::int32_t>(b)), DensityField::brick_size);
  });
  float most = brightest(uniform_values_.data(), uniform_values_.size());
  for (const float value : maxima)
    most = std::max(most, value);
  std::int32_t kept = 0;
  for (std::size_t offset = 0; offset < cells_.size(); ++offset) {
    std::int32_t& entry = cells_[offset];
    if (entry == DensityField::empty_cell)
      continue;
    const float here =
        entry >= 0 ? maxima[static_cast<std::size_t>(entry)] : max_component(uniform_value(entry));
    if (!(here > most * darkest_share)) {
      entry = DensityField::empty_cell;
      continue;
    }
    if (entry >= 0) {
      if (entry != kept)
        std::copy_n(brick(entry), DensityField::brick_size,
                    bricks_.begin() + static_cast<std::ptrdiff_t>(kept) * DensityField::brick_size);
      entry = kept++;
    }
    const auto z = static_cast<std::size_t>(cell_counts_.z),
               y = static_cast<std::size_t>(cell_counts_.y);
    const Vec3<int> cell{static_cast<int>(offset / z / y), static_cast<int>(offset / z % y),
                         static_cast<int>(offset % z)};
    occupied_.extend(Vec3f(cell) * 8.0f);
    occupied_.extend(Vec3f(cell) * 8.0f + Vec3f(8));
  }
  bricks_.resize(static_cast<std::size_t>(kept) * DensityField::brick_size);
  bricks_.shrink_to_fit();
}

std::size_t EmissionField::bytes() const {
  return cells_.size() * sizeof(std::int32_t) +
         (bricks_.size() + uniform_values_.size()) * sizeof(Rgb);
}

} // namespace vdbeam
