#pragma once

#include "medium/medium.h"

namespace vdbeam {

/// Bounds of the cells of some of the medium's volumes.
inline Boxf nest_bounds(const Medium& medium, const std::vector<std::size_t>& volumes) {
  Boxd box;
  for (const std::size_t v : volumes)
    box.extend(medium.volumes[v].bounds());
  return {Vec3f(box.lower), Vec3f(box.upper)};
}

} // namespace vdbeam
