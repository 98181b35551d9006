#include "layers/light_group_names.h"

#include <set>

namespace vdbeam {

std::vector<std::string> light_group_names(const Scene& scene) {
  std::set<std::string> names;
  bool others = scene.glows();
  for (const LightSettings& light : scene.lights) {
    if (light.group.empty())
      others = true;
    else
      names.insert(light.group);
  }
  if (!names.empty() && others)
    names.insert(rest_group);
  std::vector<std::string> list(names.begin(), names.end());
  return list;
}

} // namespace vdbeam
