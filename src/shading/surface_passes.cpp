#include "shading/surface_passes.h"

namespace vdbeam {

std::array<float, 2> surface_fit_radii(int pass) {
  struct Row {
    int end;
    std::array<float, 2> radii;
  };
  constexpr std::array<Row, 6> rows{{{4, {2.8f, 2.8f}},
                                     {12, {2, 2.8f}},
                                     {32, {1.4f, 2}},
                                     {80, {1, 1.4f}},
                                     {200, {0.7f, 0}},
                                     {600, {0.5f, 0}}}};
  for (const Row& row : rows)
    if (pass < row.end)
      return row.radii;
  return {0.25f, 0};
}

} // namespace vdbeam
