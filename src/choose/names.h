#pragma once

#include "choose/feature.h"

#include <string>

namespace vdbeam {

/// Adds a name to a list such as "light.0, light.2", once.
void add_name(const std::string& name, std::string& list);

/// What the scene file calls a light of the world, e.g. "light.0" or "mesh.2".
std::string light_name(const World& world, std::size_t light);

/// Lists the names of the lights for which is_wanted(index) holds.
template <class Predicate>
std::string light_names(const World& world, const Predicate& is_wanted) {
  std::string list;
  for (std::size_t i = 0; i < world.lights.size(); ++i)
    if (is_wanted(i))
      add_name(light_name(world, i), list);
  return list;
}

/// Lists the names of the volumes for which is_wanted(volume) holds, e.g. "volume.1".
template <class Predicate>
std::string volume_names(const World& world, const Predicate& is_wanted) {
  std::string list;
  for (const Volume& volume : world.medium.volumes)
    if (is_wanted(volume))
      add_name("volume." + std::to_string(volume.setting), list);
  return list;
}

/// What a pilot counted, e.g. "a pilot of 1024 light paths (3 % of a pass)". Empty for no work.
std::string work_text(const FeatureFacts& facts, const Choices& choices, const PilotWork& work);

} // namespace vdbeam
