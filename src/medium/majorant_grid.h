#pragma once

#include "volume/density_field.h"

namespace vdbeam {

/// Local majorants of a density field: for each 8^3 cell an upper bound of the density inside, 0
/// exactly where the field is empty.
///
/// The weight of a fluence photon is 1 / majorant, so the majorant of a cell may be at most a
/// factor `drop_limit` below that of a neighbour: otherwise a photon from a nearly empty cell would
/// cause a firefly on a ray through a dense one.
class MajorantGrid {
public:
  static constexpr float drop_limit = 32;

  MajorantGrid() = default;
  explicit MajorantGrid(const DensityField& field);

  float operator[](std::size_t cell_offset) const { return majorants_[cell_offset]; }
  /// The same for copies, and for nothing else.
  const void* values() const { return majorants_.data(); }
  std::size_t bytes() const { return majorants_.bytes(); }

private:
  SharedArray<float> majorants_;
};

} // namespace vdbeam
