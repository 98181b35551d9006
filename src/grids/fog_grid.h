#pragma once

#include "vdb/grid_shape.h"
#include "vdb/vdb_reader.h"
#include "vdbeam/scene.h"
#include "volume/field_limits.h"

namespace vdbeam {

/// The density of a volume without a file (VolumeSettings::fog), as if it had been read from one.
/// Throws FrameError where it takes more memory than there may be, and Stopped.
DensityGrid fog_grid(const VolumeSettings& volume, const FieldLimits& limits);

/// What a header would say of it.
GridSummary fog_header(const VolumeSettings& volume);

/// Where it has voxels.
GridShape fog_grid_shape(const VolumeSettings& volume);

/// Bytes of its field.
std::uint64_t fog_bytes(const VolumeSettings& volume);

} // namespace vdbeam
