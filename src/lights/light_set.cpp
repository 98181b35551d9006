#include "lights/light_set.h"

#include "lights/light_table.h"

namespace vdbeam {

LightSet::LightSet(const std::vector<LightSettings>& settings, const Vec3d& up,
                   const RenderSpace& space, const OccupiedRegion& region,
                   std::vector<std::string>* notes) {
  const LightContext context{up, space, region, notes};
  for (const LightSettings& light : settings)
    add(light_kind(light.type).make(light, context),
        {light.visible, light_kind(light.type).surrounds,
         light_kind(light.type).wants_shadow_rays(light)});
}

void LightSet::add(std::unique_ptr<Light> light, LightTraits traits) {
  any_extent_ = any_extent_ || light->has_extent();
  lights_.push_back(std::move(light));
  traits_.push_back(traits);
}

} // namespace vdbeam
