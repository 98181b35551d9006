#pragma once

#include "support/memory_scene.h"

namespace vdbeam::test::surfaces {

using Transform = std::array<double, 12>;

inline Transform scaled(double s) {
  return {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0};
}
/// Moved after that; `flipped`: the front faces -z, as a turn about x has it.
inline Transform moved(Transform map, const Vec3d& by, bool flipped = false) {
  if (flipped)
    for (int i = 4; i < 12; ++i)
      map[static_cast<std::size_t>(i)] = -map[static_cast<std::size_t>(i)];
  map[3] += by.x;
  map[7] += by.y;
  map[11] += by.z;
  return map;
}

inline MaterialSettings of_type(MaterialType type) {
  MaterialSettings material;
  material.type = type;
  return material;
}
inline MaterialSettings shining(double radiance) {
  MaterialSettings material = of_type(MaterialType::emissive);
  material.radiance = Rgb(static_cast<float>(radiance));
  return material;
}

inline MaterialSettings diffuse(double albedo) {
  MaterialSettings material;
  material.albedo = Rgb(static_cast<float>(albedo));
  return material;
}
inline MaterialSettings white() {
  return diffuse(1);
}
inline MaterialSettings glass(bool solid = false) {
  MaterialSettings material = of_type(MaterialType::dielectric);
  material.solid = solid;
  return material;
}

/// Lets the camera see a square of the plane z = 0 from straight above and far away: what lies
/// within `half` of `center` in x and y.
inline void look_down(MemoryScene& scene, double half, int pixels, const Vec3d& center = {}) {
  constexpr double height = 1000;
  scene.look(center + Vec3d{0, 0, height}, center,
             2 * std::atan(half / height) * 180 / std::numbers::pi, pixels, pixels);
}

inline SurfaceSettings& add_surface(MemoryScene& scene, SurfaceShape shape, const Transform& at,
                                    const MaterialSettings& material) {
  SurfaceSettings surface;
  surface.shape = shape;
  surface.transform = at;
  surface.material = material;
  return scene.scene.surfaces.emplace_back(surface);
}

} // namespace vdbeam::test::surfaces
