#include "lights/light_set.h"

#include "lights/light_table.h"

namespace vdbeam {

LightSet::LightSet(const std::vector<LightSettings>& settings, const Vec3d& up,
                   const RenderSpace& space, const OccupiedRegion& region,
                   std::vector<std::string>* notes) {
  const LightContext context{up, space, region, notes};
  for (const LightSettings& light : settings)
    for (const LightKind& kind : light_table())
      if (kind.type == light.type) {
        lights_.push_back(kind.make(light, context));
        lights_.back()->direct = light.direct.value_or(DirectLight::automatic);
      }
}

Rgb LightSet::escaped_radiance(const Vec3f& direction) const {
  Rgb sum;
  for (const std::unique_ptr<Light>& light : lights_)
    sum += light->escaped_radiance(direction);
  return sum;
}

} // namespace vdbeam
