#pragma once

#include "support/memory_scene.h"

namespace vdbeam::test {

/// Lumps with sharp edges in a unit cube, some in the shade of others, in the sun.
inline MemoryScene lumpy_cloud(double extinction, int width) {
  MemoryScene scene;
  const Vec3<int> cells{4, 4, 4};
  VolumeSettings& volume = scene.add(
      closed_field(cells,
                   [](int i, int j, int k) {
                     return std::sin(0.7 * i) * std::cos(0.5 * j + 1) * std::sin(0.6 * k + 2) > 0.1
                                ? 1.0
                                : 0.0;
                   }),
      box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = extinction;
  scene.add_light(LightType::distant).direction = {1, -0.4, -0.5};
  scene.look({0.5, 0.6, 2.5}, {0, 0, 0}, 24, width, width);
  return scene;
}

} // namespace vdbeam::test
