#pragma once

#include "vdb/vdb_reader.h"
#include "vdbeam/scene.h"

#include <vector>

namespace vdbeam {

/// What a bare VDB holds, which decides how it is shown.
enum class Subject { cloud, smoke, fire };

/// Choices for the image of a bare VDB, made by eye on clouds, smokes and fires of 50 to 600
/// voxels.
struct DefaultLook {
  double mean_depth;    ///< optical depth of a mean line along the longest side
  double largest_depth; ///< greatest optical depth of the densest value over the shortest side:
                        ///< keeps a thin, dense plume in a large box from becoming solid
  float albedo;
  double g;
  Vec3d sunlight; ///< direction of travel: to the viewer's right, up, towards the viewer
  Rgb irradiance;
  double fewest_voxels; ///< along the longest side; coarser grids are interpolated cubically
};

/// Whether the grids come from a simulation of gas: there is a velocity, or heat, or fire.
bool is_simulated(const std::vector<std::vector<GridSummary>>& summaries);

/// The choices for one kind of subject.
const DefaultLook& default_look(Subject subject);

} // namespace vdbeam
