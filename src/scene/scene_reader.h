#pragma once

#include "keys/scene_keys.h"
#include "scene/camera_file.h"
#include "scene/instances/instance_table.h"
#include "scene/validate.h"
#include "scene/volume_time.h"

#include <filesystem>
#include <map>
#include <string>
#include <toml++/toml.h>

namespace vdbeam {

/// Treatment of a frame for which a file of a sequence is missing: it fails, it is black, or
/// it shows the nearest earlier file (the first where there is none).
enum class MissingFile { error, black, hold };

/// Turns the tree of a scene file into a scene, for one frame.
class SceneReader {
public:
  /// `folder` is what relative paths of the file are relative to, `camera` its camera file.
  SceneReader(std::string path, std::filesystem::path folder, CameraFile& camera,
              const FrameTime& frame, MissingFile missing)
      : path_(std::move(path)), folder_(std::move(folder)), camera_file_(camera), frame_(frame),
        missing_(missing) {
    scene_.frame = frame;
  }

  /// Throws InputError with file and line.
  Scene read(const toml::table& root);

private:
  void add_suns();
  void read_rows(std::size_t index, const toml::node& node);
  std::vector<InstanceRow> rows_of(std::size_t index) const;
  void place_instances();
  void set_file_times();
  void use_file_materials();
  [[noreturn]] void fail_unnamed(std::size_t index) const;
  void note_idle_keys();
  void note_units();
  void read_section(SceneSection section, const toml::node& node);
  void read_list(SceneSection section, const toml::node& node);
  void read_table(SceneSection section, std::size_t index, const toml::table& table);
  void read_typed_part(SceneSection section, std::size_t index, const toml::node& node,
                       const char* example);
  void read_emission(std::size_t index, const toml::node& node);
  void read_part(SceneSection section, std::size_t index, const toml::table& table);
  void read_key(const SceneKey& key, std::size_t index, const toml::node& node);
  void check_required(SceneSection section, std::size_t index, const toml::table& table) const;
  void check_types(SceneSection section, std::size_t index, const toml::table& table) const;
  void check_power(SceneSection section, std::size_t index, const toml::table& table) const;
  void place(SceneSection section, std::size_t index);
  void place_camera(const toml::table& table);
  std::string resolve_file(const SceneKey& key, std::size_t index, const std::string& text,
                           const toml::node& node);
  std::string resolve_missing(const std::string& key, const std::string& pattern, int number,
                              const toml::node& node);
  std::string locate(const std::string& key) const;
  [[noreturn]] void fail_unknown(SceneSection section, std::size_t index, const std::string& name,
                                 const toml::node& node) const;

  std::string path_;
  std::filesystem::path folder_;
  CameraFile& camera_file_;
  FrameTime frame_;
  MissingFile missing_;
  std::optional<VolumeTime> time_; ///< of the volume that is being read
  Scene scene_;
  std::map<std::string, std::string> locations_;         ///< of the keys that were read
  std::map<std::string, std::vector<double>> placement_; ///< translate, rotate, scale
  std::vector<const toml::node*> rows_; ///< of tables of instances; null: they are in a file
};

} // namespace vdbeam
