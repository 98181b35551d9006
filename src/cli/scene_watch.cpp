#include "cli/scene_watch.h"

#include "text/frame_range.h"
#include "vdbeam/error.h"

#include <sys/stat.h>

namespace vdbeam::cli {

SceneWatch::Stamp SceneWatch::stamp(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0)
    return {};
  constexpr std::int64_t nanoseconds = 1'000'000'000;
  return {true, static_cast<std::uintmax_t>(status.st_size),
          status.st_mtim.tv_sec * nanoseconds + status.st_mtim.tv_nsec, status.st_ino};
}

void SceneWatch::look_again() {
  stamps_.try_emplace(scene_path_);
  for (auto& [path, before] : stamps_)
    before = stamp(path);
}

void SceneWatch::name_files(const SceneDocument& document, int frame) {
  std::map<std::string, Stamp> named{{scene_path_, stamps_[scene_path_]}};
  const auto add = [&](const std::string& path) {
    const auto known = stamps_.find(path);
    named[path] = known != stamps_.end() ? known->second : stamp(path);
  };
  for (const SceneFile& file : document.files()) {
    const std::string path = substitute_frame(file.pattern, frame);
    add(path);
    try {
      for (const std::string& other : files_named_by(file.input, path))
        add(other);
    } catch (const InputError&) { // the render says what is wrong with it
    }
  }
  stamps_ = std::move(named);
}

std::vector<std::string> SceneWatch::changed() const {
  std::vector<std::string> paths;
  for (const auto& [path, before] : stamps_)
    if (stamp(path) != before)
      paths.push_back(path);
  return paths;
}

bool SceneWatch::only_scene(const std::vector<std::string>& changed) const {
  return changed.size() == 1 && changed.front() == scene_path_;
}

} // namespace vdbeam::cli
