#pragma once

#include "scene/scene_document.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// Watches a scene file and the files that it names, by their sizes and times of change: that works
/// on network file systems, too, where the kernel reports nothing.
class SceneWatch {
public:
  explicit SceneWatch(const std::string& scene_path) : scene_path_(scene_path) { look_again(); }

  /// Takes the files as they are now for unchanged.
  void look_again();
  /// Watches the scene file, and the files that the document names for the frame, as they are now
  /// where they were not watched before.
  void name_files(const SceneDocument& document, int frame);

  /// The paths of those that have changed, were removed or came; none: all are the same.
  std::vector<std::string> changed() const;
  /// Whether only the scene file is among them.
  bool only_scene(const std::vector<std::string>& changed) const;

private:
  struct Stamp {
    bool there = false;
    std::uintmax_t size = 0;
    std::int64_t time = 0;
    std::uint64_t inode = 0;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stamp(const std::string& path);

  std::string scene_path_;
  std::map<std::string, Stamp> stamps_;
};

} // namespace vdbeam::cli
