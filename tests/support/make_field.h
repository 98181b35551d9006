#pragma once

#include "volume/density_field.h"

namespace vdbeam::test {

/// A field of lattice points (0, 0, 0) to (nx - 1, ny - 1, nz - 1), which are local and index
/// coordinates alike, with the values `value(i, j, k)`; 0 all around, as in any DensityField.
/// Lower borders end abruptly at 0 (there is no cell below); start `value` with a layer of zeros
/// where the ramp below the first voxel matters.
template <class Value>
DensityField make_field(int nx, int ny, int nz, Value value) {
  constexpr int cell = cell_width, brick = brick_width;
  const Vec3<int> counts{(nx + cell - 1) / cell, (ny + cell - 1) / cell, (nz + cell - 1) / cell};
  std::vector<std::int32_t> cells;
  std::vector<float> bricks, uniform_values;
  const auto at = [&](int i, int j, int k) {
    return i < nx && j < ny && k < nz ? static_cast<float>(value(i, j, k)) : 0.0f;
  };
  for (int i = 0; i < counts.x; ++i)
    for (int j = 0; j < counts.y; ++j)
      for (int k = 0; k < counts.z; ++k) {
        std::vector<float> values;
        for (int x = 0; x < brick; ++x)
          for (int y = 0; y < brick; ++y)
            for (int z = 0; z < brick; ++z)
              values.push_back(at(cell * i + x, cell * j + y, cell * k + z));
        const bool same = std::all_of(values.begin(), values.end(),
                                      [&values](float v) { return v == values.front(); });
        if (same && values.front() == 0) {
          cells.push_back(DensityField::empty_cell);
        } else if (same) {
          cells.push_back(DensityField::uniform_base -
                          static_cast<std::int32_t>(uniform_values.size()));
          uniform_values.push_back(values.front());
        } else {
          cells.push_back(static_cast<std::int32_t>(bricks.size() / DensityField::brick_size));
          bricks.insert(bricks.end(), values.begin(), values.end());
        }
      }
  return DensityField({0, 0, 0}, counts, std::move(cells), std::move(bricks),
                      std::move(uniform_values));
}

} // namespace vdbeam::test
