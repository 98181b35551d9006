#include "live/scene_changes.h"

#include "keys/scene_keys.h"

#include <algorithm>

namespace vdbeam {
namespace {

/// "light.2" of "light.2.exposure".
std::string table_of(const std::string& path) {
  return path.substr(0, path.find('.', path.find('.') + 1));
}

} // namespace

std::vector<std::string> changed_keys(const Scene& before, const Scene& after) {
  std::vector<std::string> changed;
  for (const SceneKey& key : scene_keys()) {
    if (!key.get)
      continue;
    const std::size_t old_count = section_count(before, key.section);
    const std::size_t new_count = section_count(after, key.section);
    for (std::size_t i = 0; i < std::min(old_count, new_count); ++i)
      if (key.get(before, i) != key.get(after, i))
        changed.push_back(key_path(key, i));
    for (std::size_t i = std::min(old_count, new_count); i < std::max(old_count, new_count); ++i)
      if (const std::string table = table_of(key_path(key, i));
          std::find(changed.begin(), changed.end(), table) == changed.end())
        changed.push_back(table);
  }
  return changed;
}

} // namespace vdbeam
