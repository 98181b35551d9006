#pragma once

#include "math/unfilled_array.h"
#include "vdbeam/vec.h"

#include <cstdint>

namespace vdbeam {

/// A photon's place and where it was in its list.
struct OrderedPhoton {
  Vec3f position;
  std::uint32_t index;
};

/// Puts photons in kd-median order: every aligned run of 16 * 2^l photons is a cell of a kd tree
/// whose splits halve the longest side of the cell's tight box. The result depends only on the
/// input.
void order_photons(UnfilledArray<OrderedPhoton>& photons);

} // namespace vdbeam
