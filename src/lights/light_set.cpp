#include "lights/light_set.h"

#include "lights/light_table.h"

namespace vdbeam {

LightSet::LightSet(const std::vector<LightSettings>& settings, const Vec3d& up,
                   const RenderSpace& space, const OccupiedRegion& region,
                   std::vector<std::string>* notes) {
  const LightContext context{up, space, region, notes};
  for (const LightSettings& light : settings)
    add(make_light(light, context), {light.visible, light_kind(light.type).surrounds,
                                     light_kind(light.type).wants_shadow_rays(light)});
}

void LightSet::sort_into_groups(int count, const std::vector<int>& of_light, int of_emission) {
  group_count_ = count;
  group_of_emission_ = of_emission;
  for (std::size_t i = 0; i < traits_.size(); ++i)
    traits_[i].group = of_light[i];
}

void LightSet::add(std::unique_ptr<Light> light, LightTraits traits) {
  if (!light->is_delta() && light->surface() < 0)
    met_by_rays_.push_back(lights_.size());
  any_extent_ = any_extent_ || light->has_extent();
  lights_.push_back(std::move(light));
  traits_.push_back(traits);
}

} // namespace vdbeam
