#include "lights/light_groups.h"

#include "materials/material_table.h"

#include <algorithm>
#include <set>

namespace vdbeam {

std::vector<std::string> light_group_names(const Scene& scene) {
  std::set<std::string> names;
  bool others = scene.glows();
  const auto take = [&](const std::string& group) {
    if (group.empty())
      others = true;
    else
      names.insert(group);
  };
  for (const LightSettings& light : scene.lights)
    take(light.group);
  for (const SurfaceSettings& surface : scene.surfaces)
    if (shines(surface.material))
      take(surface.group);
  if (!names.empty() && others)
    names.insert(rest_group);
  return {names.begin(), names.end()};
}

int LightGroups::number(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name.empty() ? rest_group : name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

} // namespace vdbeam
