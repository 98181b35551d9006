#pragma once

#include "grids/fog_grid.h"
#include "support/memory_scene.h"

namespace vdbeam::test {

inline VolumeSettings fog(VolumeShape shape, const Vec3d& lower, const Vec3d& upper,
                          double extinction = 1) {
  VolumeSettings volume;
  volume.fog.shape = shape;
  volume.box_lower = lower;
  volume.box_upper = upper;
  volume.extinction = extinction;
  return volume;
}

/// Adds a volume without a file to a scene in memory.
inline VolumeSettings& add_fog(MemoryScene& scene, const VolumeSettings& volume) {
  scene.grids.push_back(fog_grid(volume, std::uint64_t(1) << 32));
  return scene.scene.volumes.emplace_back(volume);
}

} // namespace vdbeam::test
