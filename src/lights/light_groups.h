#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// The group of the lights that have none, and of volumes that glow.
inline constexpr const char* rest_group = "rest";

/// The groups of a scene's lights, meshes that shine among them, in the order of their names;
/// "rest" among them for those without one and for volumes that glow, where there are any. Empty
/// where no light has a group.
std::vector<std::string> light_group_names(const Scene& scene);

/// The number of each group, in the order of light_group_names.
class LightGroups {
public:
  explicit LightGroups(const Scene& scene) : names_(light_group_names(scene)) {}

  int count() const { return static_cast<int>(names_.size()); }
  /// Number of the group with this name; without a name, that of the rest. -1 without groups.
  int number(const std::string& name) const;

private:
  std::vector<std::string> names_;
};

} // namespace vdbeam
