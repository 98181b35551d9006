#pragma once

#include "math/stop_token.h"
#include "text/curve.h"
#include "vdb/vdb_reader.h"
#include "vdbeam/volume_edits.h"

#include <optional>

namespace vdbeam {

/// What look development makes of a grid, lattice point by lattice point, so that bricks, majorants
/// and tracking are as exact as for a file that holds the result.
struct GridEdits {
  DensityRemap remap;
  Affine to_world; ///< of the grid's index coordinates
  /// Values at lattice points outside of it are 0; those on its faces, within a millionth of a
  /// voxel, belong to it [world].
  std::optional<Boxd> box;
  const DensityGrid* mask = nullptr; ///< multiplies values, before they are mapped
  Affine mask_to_world;

  bool changes() const { return remap.changes() || box || mask; }
};

/// A value after the remapping; 0 stays 0.
float remapped(const DensityRemap& remap, float value);
/// The same with its curve read already; null: it has none.
float remapped(const DensityRemap& remap, const Curve* curve, float value);

/// Applies the edits to a field with this origin. Throws Stopped.
DensityField edited_field(const DensityField& field, const GridEdits& edits,
                          const StopToken* stop = nullptr);

} // namespace vdbeam
