#include "vdb/density_kind.h"

#include "text/text.h"

#include <fmt/format.h>

namespace vdbeam {

bool is_level_set(const GridSummary& grid) {
  return lower_case(grid.grid_class) == "level set";
}

GridKind kind_of(const GridSummary& grid) {
  return {grid.value_type, grid.map_type, grid.map_type != "NonlinearFrustumMap",
          is_level_set(grid), grid.background};
}

std::optional<std::string> why_no_density(const GridKind& kind) {
  if (kind.value_type != "float" && kind.value_type != "half" && kind.value_type != "double")
    return fmt::format("holds {} values, but only float and half grids can be rendered",
                       kind.value_type);
  if (!kind.linear)
    return fmt::format("has a {}, not an affine transform; resample it to a uniform grid",
                       kind.map_type);
  if (kind.level_set && !(kind.background > 0))
    return fmt::format("is a level set with the background {:g}, which must be above 0",
                       kind.background);
  if (!kind.level_set && kind.background != 0)
    return fmt::format("has the background value {:g}, so the medium would have no end; set the "
                       "background to 0 (or, for a level set, its class to \"level set\")",
                       kind.background);
  return std::nullopt;
}

} // namespace vdbeam
