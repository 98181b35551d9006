#pragma once

#include "volume_factory.h"

#include <openvdb/openvdb.h>

namespace vdbeam {

/// Clouds for look development, saved as half floats. Each is `extent` wide, `size` voxels across,
/// and stands on y = 0; its density lies in [0, `density`]. The same options give the same file.

/// A fair-weather cumulus; its greatest density is near the top.
openvdb::FloatGrid::Ptr cumulus(const VolumeOptions& options);

/// A storm with an anvil, 0.7 of `extent` high.
openvdb::FloatGrid::Ptr storm(const VolumeOptions& options);

/// Many small cumuli in streets over a square; about 0.08 of `extent` high.
openvdb::FloatGrid::Ptr cumulus_field(const VolumeOptions& options);

/// A bank of fog with an uneven top, about 0.1 of `extent` high, thinner with height.
openvdb::FloatGrid::Ptr fog_bank(const VolumeOptions& options);

} // namespace vdbeam
