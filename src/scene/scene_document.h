#pragma once

#include "scene/overrides.h"
#include "scene/scene_inputs.h"
#include "scene/scene_reader.h"
#include "vdbeam/scene.h"

#include <filesystem>
#include <memory>
#include <string>
#include <toml++/toml.h>
#include <vector>

namespace vdbeam {

/// A scene file, or what stands for it for a bare VDB, from which the scene of each frame is made.
class SceneDocument {
public:
  /// Throws InputError for a file that cannot be read or is not TOML, and for overrides that lead
  /// nowhere. A VDB's header and values are read to choose camera and extinction.
  SceneDocument(const std::string& path, const std::vector<Override>& overrides);

  /// The same from a file's text, which `path` names in messages.
  SceneDocument(const std::string& text, const std::string& path,
                const std::vector<Override>& overrides);

  /// Throws InputError as load_scene.
  Scene scene_at(const FrameTime& frame, MissingFile missing = MissingFile::error) const;

  /// Where a path holds a frame number's place.
  bool has_frame_pattern() const;
  /// Whether anything but random numbers may differ between two frames: a value with keys, a file
  /// of a sequence, a camera from a file.
  bool depends_on_frame() const;
  /// Frames for which the first file with a frame pattern exists.
  std::vector<int> frames_on_disk() const;

  /// Every file that the scene names by a key.
  std::vector<SceneFile> files() const;

  /// Prefix of a message about a file of this frame's scene: "scene.toml:12: volume.0.file:
  /// ", or the key that names the grid that the line is about. Empty for a bare VDB, which names
  /// itself, and for a line about anything else.
  std::string whose_file(const Scene& scene, const std::string& line) const;

private:
  std::string first_pattern() const;
  /// "scene.toml:12: volume.0.file: "
  std::string where(const std::string& key) const;
  void check_named_files(const Scene& scene) const;
  /// Location of the first name in quotes; empty if no key of the volume in the file contains it.
  std::string who_names(std::size_t volume, const std::string& line) const;

  std::string path_;
  std::filesystem::path folder_;
  toml::table root_;
  std::vector<std::string> notes_;
  std::shared_ptr<CameraFile> camera_file_ = std::make_shared<CameraFile>();
};

/// True for a file whose name or first bytes say that it is a VDB.
bool is_vdb_file(const std::string& path);

} // namespace vdbeam
