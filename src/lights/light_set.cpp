#include "lights/light_set.h"

#include "lights/light_table.h"

namespace vdbeam {

LightSet::LightSet(const std::vector<LightSettings>& settings, const Vec3d& up,
                   const RenderSpace& space, const OccupiedRegion& region,
                   std::vector<std::string>* notes) {
  const LightContext context{up, space, region, notes};
  for (const LightSettings& light : settings)
    add(make_light(light, context),
        {light.visible, light_kind(light.type).surrounds,
         light_kind(light.type).wants_shadow_rays(light)});
}

LightSet LightSet::only(const std::vector<bool>& chosen) const {
  LightSet result;
  for (std::size_t i = 0; i < lights_.size(); ++i)
    if (chosen[i]) {
      result.any_extent_ = result.any_extent_ || lights_[i]->has_extent();
      result.lights_.push_back(lights_[i]);
      result.traits_.push_back(traits_[i]);
    }
  return result;
}

void LightSet::add(std::unique_ptr<Light> light, LightTraits traits) {
  any_extent_ = any_extent_ || light->has_extent();
  lights_.push_back(std::move(light));
  traits_.push_back(traits);
}

} // namespace vdbeam
