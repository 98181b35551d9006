#include "geometry/mesh_reader.h"
#include "machine/input_file.h"
#include "scene/scene_reader.h"
#include "scene/toml_value.h"
#include "text/frame_range.h"
#include "text/missing_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <system_error>

namespace vdbeam {

std::string SceneReader::resolve_file(const SceneKey& key, std::size_t index,
                                      const std::string& text, const toml::node& node) {
  namespace fs = std::filesystem;
  // A path typed in a shell is relative to where it was typed.
  const std::string pattern = (is_override(node) ? fs::path(text) : folder_ / text).string();
  int number = frame_.number;
  if (key.section == SceneSection::volume && time_ && !has_frame_pattern(pattern))
    scene_.notes.push_back(fmt::format("{}: volume.{}.time does nothing: file names a single file, "
                                       "not a sequence like smoke.####.vdb",
                                       location_of(node), index));
  if (key.section == SceneSection::volume && time_ && has_frame_pattern(pattern)) {
    const auto mapped = time_->file_frame(frame_.number, frames_on_disk(pattern));
    if (!mapped) {
      scene_.volumes[index].present = false;
      return pattern;
    }
    number = *mapped;
  }
  std::string file = substitute_frame(pattern, number);
  if (key.section == SceneSection::mesh && !is_mesh_file(file))
    throw InputError(one_line(fmt::format("{}: {}: {} cannot be read: a mesh is an .obj, .ply, "
                                          ".gltf or .glb file",
                                          location_of(node), key_path(key, index), file)));
  const std::string path = key_path(key, index);
  std::error_code error;
  const bool is_folder = fs::is_directory(file, error);
  if (!is_folder && is_there(file)) {
    try {
      check_input_file(file, EmptyFile::accepted);
    } catch (const InputError& problem) {
      throw InputError(fmt::format("{}: {}: {}", location_of(node), path, problem.what()));
    }
    return file;
  }
  if (is_folder)
    throw InputError(one_line(fmt::format("{}: {}: there is no file {}, which is a folder",
                                          location_of(node), path, file)));
  if (key.section == SceneSection::volume && missing_ == MissingFile::black &&
      has_frame_pattern(pattern)) {
    scene_.black = true;
    scene_.volumes[index].present = false;
    return file;
  }
  return resolve_missing(path, pattern, number, node);
}

/// Replacement for a missing file.
std::string SceneReader::resolve_missing(const std::string& key, const std::string& pattern,
                                         int number, const toml::node& node) {
  const std::string file = substitute_frame(pattern, number);
  const std::vector<int> frames = frames_on_disk(pattern);
  if (missing_ != MissingFile::hold || frames.empty())
    throw InputError(fmt::format(
        "{}: {}: {}", location_of(node), key,
        frames.empty() ? missing_file_text(pattern)
                       : one_line(fmt::format("there is no file {}; there are frames {}", file,
                                              format_frame_range(frames)))));
  int held = frames.front();
  for (const int frame : frames)
    if (frame <= number)
      held = frame;
  scene_.notes.push_back(
      one_line(fmt::format("{}: there is no file {}; frame {} is shown", key, file, held)));
  return substitute_frame(pattern, held);
}

} // namespace vdbeam
