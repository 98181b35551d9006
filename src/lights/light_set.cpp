#include "lights/light_set.h"

#include "lights/light_table.h"

namespace vdbeam {

LightSet::LightSet(const std::vector<LightSettings>& settings, const Vec3d& up,
                   const RenderSpace& space, const OccupiedRegion& region,
                   std::vector<std::string>* notes) {
  const LightContext context{up, space, region, notes};
  for (const LightSettings& light : settings)
    for (const LightKind& kind : light_table())
      if (kind.type == light.type)
        add(kind.make(light, context), light.direct.value_or(DirectLight::automatic),
            light.visible);
}

void LightSet::add(std::unique_ptr<Light> light, DirectLight direct, bool visible) {
  any_extent_ = any_extent_ || light->has_extent();
  lights_.push_back(std::move(light));
  direct_.push_back(direct);
  visible_.push_back(visible);
}

} // namespace vdbeam
