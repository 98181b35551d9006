#pragma once

#include "vdb/raw_grid.h"
#include "vdb/vdb_reader.h"

#include <algorithm>
#include <array>

namespace vdbeam {

struct ValueRange {
  float lowest = 0, highest = 0;
  void extend(const ValueRange& other) {
    lowest = std::min(lowest, other.lowest);
    highest = std::max(highest, other.highest);
  }
};

/// Smallest and largest value of a leaf's eight regions. Region r leaves an axis whole where r's
/// bit (4: x, 2: y, 1: z) is 0, and holds its first layer only where the bit is 1: just what the
/// cell below along those axes takes from the leaf as its apron.
using LeafRanges = std::array<ValueRange, 8>;

/// Requires mended values: finite, not negative, no -0.
LeafRanges measure_leaf(const float* values);

/// Turns a file's values into densities (finite, not negative, no -0) and counts what was mended.
class Mender {
public:
  /// Looks for a level set's depth in the grid's values, which must not be mended yet.
  explicit Mender(const RawGrid& grid);

  /// The density for a value; `weight` is for how many voxels it stands.
  float mend(float value, GridRepairs& repairs, std::uint64_t weight = 1) const;
  void mend_leaf(float* values, GridRepairs& repairs) const;

private:
  bool level_set_;
  float per_distance_; ///< level set: density per distance inside the surface
};

} // namespace vdbeam
