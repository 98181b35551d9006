#include "volume/color_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {
namespace {

constexpr std::size_t brick_size = DensityField::brick_size;

} // namespace

ColorField::ColorField(const DensityField& shape,
                       const std::function<Rgb(const Vec3d& local)>& color, const StopToken* stop)
    : cell_counts_(shape.cell_counts()) {
  const Vec3<int>& n = cell_counts_;
  cells_.assign(static_cast<std::size_t>(n.x) * n.y * n.z, -1);
  std::int32_t bricks = 0;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell)
    if (shape.cell_maximum(cell) > 0)
      cells_[cell] = bricks++;
  bricks_.resize(static_cast<std::size_t>(bricks) * brick_size);
  tbb::parallel_for(0, n.x * n.y, [&](int column) {
    for (int k = 0; k < n.z; ++k) {
      const int i = column / n.y, j = column % n.y;
      const std::int32_t brick = cells_[shape.cell_offset(i, j, k)];
      if (brick < 0)
        continue;
      if (stop)
        stop->check();
      const Vec3d corner = Vec3d(Vec3<int>{i, j, k}) * double{cell_width};
      Rgb* out = bricks_.data() + static_cast<std::size_t>(brick) * brick_size;
      for (int x = 0; x < brick_width; ++x)
        for (int y = 0; y < brick_width; ++y)
          for (int z = 0; z < brick_width; ++z)
            *out++ = color(corner + Vec3d(Vec3<int>{x, y, z}));
    }
  });
}

Rgb ColorField::sample(const Vec3f& local) const {
  Vec3<int> cell, voxel;
  Vec3f f;
  for (int a = 0; a < 3; ++a) {
    // Rounding may have put a point of the medium beyond a face.
    const float x = std::clamp(local[a], 0.0f, static_cast<float>(cell_width * cell_counts_[a]));
    const int below = std::min(static_cast<int>(x), cell_width * cell_counts_[a] - 1);
    cell[a] = below / cell_width;
    voxel[a] = below % cell_width;
    f[a] = x - static_cast<float>(below);
  }
  const std::size_t offset =
      (static_cast<std::size_t>(cell.x) * cell_counts_.y + cell.y) * cell_counts_.z + cell.z;
  if (cells_[offset] < 0)
    return Rgb(1);
  const Rgb* p = bricks_.data() + static_cast<std::size_t>(cells_[offset]) * brick_size +
                 (voxel.x * brick_width + voxel.y) * brick_width + voxel.z;
  const auto along_z = [&](int at) { return p[at] + (p[at + 1] - p[at]) * f.z; };
  const auto along_y = [&](int at) {
    const Rgb low = along_z(at);
    return low + (along_z(at + brick_width) - low) * f.y;
  };
  const Rgb low = along_y(0);
  return low + (along_y(brick_width * brick_width) - low) * f.x;
}

std::size_t ColorField::bytes() const {
  return cells_.size() * sizeof(std::int32_t) + bricks_.size() * sizeof(Rgb);
}

std::uint64_t ColorField::bytes_of(const DensityField& shape) {
  const Vec3<int>& n = shape.cell_counts();
  const std::size_t cells = static_cast<std::size_t>(n.x) * n.y * n.z;
  std::uint64_t bricks = 0;
  for (std::size_t cell = 0; cell < cells; ++cell)
    bricks += shape.cell_maximum(cell) > 0;
  return cells * sizeof(std::int32_t) + bricks * brick_size * sizeof(Rgb);
}

} // namespace vdbeam
