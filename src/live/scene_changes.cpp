#include "live/scene_changes.h"

#include "keys/scene_keys.h"

#include <algorithm>

namespace vdbeam {

std::vector<std::string> changed_keys(const Scene& before, const Scene& after) {
  std::vector<std::string> changed;
  for (const SceneKey& key : scene_keys()) {
    if (!key.get)
      continue;
    const std::size_t old_count = section_count(before, key.section);
    const std::size_t new_count = section_count(after, key.section);
    for (std::size_t i = 0; i < std::max(old_count, new_count); ++i)
      if (i >= old_count || i >= new_count || key.get(before, i) != key.get(after, i))
        changed.push_back(key_path(key, i));
  }
  return changed;
}

} // namespace vdbeam
