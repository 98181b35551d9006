#include "medium/majorant_grid.h"

#include <tbb/parallel_for.h>

namespace vdbeam {

namespace {

/// One round of the drop limit: every non-empty cell rises to 1 / drop_limit of its largest
/// neighbour. Two rounds reach two cells far, beyond which no kernel is wide enough to matter.
std::vector<float> limit_drop(const DensityField& field, const std::vector<float>& majorants) {
  const Vec3<int> n = field.cell_counts();
  std::vector<float> result(majorants);
  tbb::parallel_for(0, n.x, [&](int i) {
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const std::size_t cell = field.cell_offset(i, j, k);
        if (majorants[cell] == 0)
          continue;
        float largest = 0;
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, n.x - 1); ++a)
          for (int b = std::max(j - 1, 0); b <= std::min(j + 1, n.y - 1); ++b)
            for (int c = std::max(k - 1, 0); c <= std::min(k + 1, n.z - 1); ++c)
              largest = std::max(largest, majorants[field.cell_offset(a, b, c)]);
        result[cell] = std::max(majorants[cell], largest / MajorantGrid::drop_limit);
      }
  });
  return result;
}

} // namespace

MajorantGrid::MajorantGrid(const DensityField& field) {
  const Vec3<int> n = field.cell_counts();
  std::vector<float> majorants(static_cast<std::size_t>(n.x) * n.y * n.z);
  for (std::size_t cell = 0; cell < majorants.size(); ++cell)
    majorants[cell] = field.cell_maximum(cell);
  majorants = limit_drop(field, majorants);
  majorants_ = SharedArray<float>(limit_drop(field, majorants));
}

} // namespace vdbeam
