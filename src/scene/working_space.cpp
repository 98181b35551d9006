#include "scene/working_space.h"

#include "keys/scene_keys.h"

namespace vdbeam {

Scene in_working_space(Scene scene) {
  const ColorSpace space = scene.image.working_space;
  if (space == ColorSpace::rec709)
    return scene;
  const ColorMatrix matrix =
      rgb_matrix(chromaticities_of(ColorSpace::rec709), chromaticities_of(space));
  for (const SceneKey& key : scene_keys()) {
    if (key.kind != KeyKind::color || !key.get || !key.set)
      continue;
    for (std::size_t i = 0; i < section_count(scene, key.section); ++i) {
      const KeyValue value = key.get(scene, i);
      const auto* rgb = std::get_if<std::vector<double>>(&value);
      if (!rgb || rgb->size() != 3 || ((*rgb)[0] == (*rgb)[1] && (*rgb)[1] == (*rgb)[2]))
        continue;
      const Vec3d c = matrix.apply({(*rgb)[0], (*rgb)[1], (*rgb)[2]});
      key.set(scene, i, std::vector<double>{c.x, c.y, c.z});
    }
  }
  for (VolumeSettings& volume : scene.volumes)
    volume.emission.color_space = space;
  for (LightSettings& light : scene.lights)
    light.color_space = space;
  for (SurfaceSettings& surface : scene.surfaces)
    surface.material.color_space = space;
  return scene;
}

} // namespace vdbeam
