#pragma once

#include "vdb/vdb_reader.h"
#include "vdbeam/scene.h"
#include "volume/emission_field.h"
#include "volume/field_limits.h"

#include <memory>

namespace vdbeam {

/// The light that a volume sends out, ready to render but for its strength: the values are
/// intensity times blackbody; `scale` and `color` are left to the renderer.
struct EmissionGrid {
  std::shared_ptr<const EmissionField> field; ///< null where nothing glows
  Affine index_to_world;                      ///< of the field
  std::uint64_t active_voxels = 0;            ///< of the grids that were read
  std::vector<std::string> notes;

  bool empty() const { return !field || field->empty(); }
};

/// Emission of a black body at a grid's value, by the settings' law; 0 where the value is 0.
Rgb blackbody_emission(const EmissionSettings& settings, float value);

/// Emission at the voxels of the intensity grid, or of the temperature grid where there is no
/// other; a temperature on another lattice is interpolated there. The grids that the settings name
/// must be given. Throws FrameError, opening with `label`, where the field would exceed the limit,
/// and Stopped.
EmissionGrid make_emission(const EmissionSettings& settings, const DensityGrid& intensity,
                           const DensityGrid& temperature, const std::string& label,
                           const FieldLimits& limits);

} // namespace vdbeam
