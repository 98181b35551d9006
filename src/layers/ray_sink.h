#pragma once

#include "layers/deep_ray.h"
#include "layers/ray_layers.h"

namespace vdbeam {

/// Where light goes that is scattered into a ray of the picture, beyond the pixel's own sums: to
/// the pieces of the deep pixel, by how deep it was scattered, and to the layers of volumes, by
/// which of them scattered it. Everything that sorts light by its place goes through here; without
/// deep picture and layers it does nothing.
struct RaySink {
  RaySink() = default;
  RaySink(const DeepRay& deep_ray, const VolumeLights& lights) : deep(deep_ray), volumes(lights) {}
  /// Takes the light of a camera ray of `pixel`. `layers`: the layers to fill; null: none.
  RaySink(const World& world, const CameraRay& camera, const RayLayers* layers, std::size_t pixel,
          PassImage& image)
      : deep(world, camera, pixel, image), volumes(layers, pixel, image) {}

  /// Light that volume `setting` of the scene scatters into the ray at the distance t.
  void add(float t, std::size_t setting, const Rgb& light) const {
    deep.add_light_at(t, light);
    volumes.add(setting, light);
  }

  DeepRay deep;
  VolumeLights volumes;
};

} // namespace vdbeam
