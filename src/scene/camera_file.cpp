#include "scene/camera_file.h"

#include "geometry/gltf/gltf_camera.h"
#include "geometry/gltf/gltf_files.h"
#include "keys/scene_enums.h"
#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <numbers>
#include <sstream>
#include <vector>

namespace vdbeam {
namespace {

/// Half a million lines, and a line of a thousand numbers: what has more is no camera.
constexpr std::size_t longest_file = std::size_t(64) << 20, longest_line = std::size_t(64) << 10;
constexpr std::size_t chan_numbers = 7, chan_numbers_with_fov = 8, matrix_numbers = 16;

using CameraKey = CameraFile::Key;

[[noreturn]] void fail(const std::string& path, int line, const std::string& text) {
  const std::string place = line > 0 ? fmt::format(":{}", line) : "";
  throw InputError(one_line(fmt::format("{}{}: {}", path, place, text)));
}

/// The numbers of a line; brackets and commas, as programs print matrices, count as spaces. Errors
/// quote nothing: the file may be one that only the program may read, not who sees its messages.
std::vector<double> numbers_of(std::string text, const std::string& path, int line) {
  for (char& c : text)
    if (c == ',' || c == ';' || c == '[' || c == ']' || c == '(' || c == ')')
      c = ' ';
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end); // also a number below 2.2e-308
    if (end != word.c_str() + word.size() || !std::isfinite(value))
      fail(path, line, "must hold finite numbers and nothing else");
    numbers.push_back(value);
  }
  return numbers;
}

CameraKey key_of(const std::vector<double>& numbers, const std::string& path, int line) {
  const std::size_t n = numbers.size();
  if (n == matrix_numbers)
    return {0, numbers, line};
  if (n == chan_numbers || n == chan_numbers_with_fov || n == matrix_numbers + 1)
    return {numbers[0], {numbers.begin() + 1, numbers.end()}, line};
  fail(path, line,
       fmt::format("must hold frame, translation, rotation and field of view (7 or 8 numbers), or "
                   "a matrix (16, or 17 with the frame), got {}",
                   count_text(n, "number")));
}

/// The keys of a text file.
std::vector<CameraKey> read_lines(const std::string& path) {
  std::istringstream stream(read_text(path, longest_file));
  std::vector<CameraKey> keys;
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    if (text.size() > longest_line)
      fail(path, line,
           fmt::format("must have lines of at most {}",
                       format_bytes(static_cast<double>(longest_line))));
    if (const auto comment = text.find('#'); comment != std::string::npos)
      text.erase(comment);
    const std::vector<double> numbers = numbers_of(text, path, line);
    if (numbers.empty())
      continue;
    keys.push_back(key_of(numbers, path, line));
    if (keys.size() == 1)
      continue;
    if (keys.back().values.size() != keys.front().values.size())
      fail(path, line, "must hold the same number of values as the previous line");
    if (!(keys.back().frame > keys[keys.size() - 2].frame))
      fail(path, line, "must have a greater frame number than the line before");
  }
  if (keys.empty())
    throw InputError(one_line(path + ": holds no camera"));
  return keys;
}

/// The keys of a camera of a glTF file, as matrices that act on columns, and its field of view.
std::vector<CameraKey> read_gltf(const CameraSettings& settings, std::optional<double>& fov) {
  constexpr double samples_per_frame = 4; // between which matrices may be mixed
  const CameraTrack track =
      read_gltf_camera(settings.file, settings.name, samples_per_frame * settings.file_fps);
  fov = track.fov;
  std::vector<CameraKey> keys;
  for (const CameraTrack::Key& key : track.keys) {
    CameraKey& next = keys.emplace_back();
    next.frame = key.seconds * settings.file_fps;
    for (int row = 0; row < 3; ++row) {
      const Vec3d& r = key.to_world.rows[static_cast<std::size_t>(row)];
      next.values.insert(next.values.end(), {r.x, r.y, r.z, key.to_world.translation[row]});
    }
    next.values.insert(next.values.end(), {0, 0, 0, 1});
  }
  return keys;
}

/// Rotation of `v` about an axis (0: X, ...) by an angle in degrees.
Vec3d rotated(const Vec3d& v, int axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  Vec3d result = v;
  result[a] = c * v[a] - s * v[b];
  result[b] = s * v[a] + c * v[b];
  return result;
}

CameraPose chan_pose(const std::vector<double>& values, RotationOrder order) {
  const auto turned = [&](Vec3d v) {
    for (const char axis : enum_name(order))
      v = rotated(v, axis - 'x', values[static_cast<std::size_t>(3 + axis - 'x')]);
    return v;
  };
  CameraPose pose{{values[0], values[1], values[2]}, turned({0, 0, -1}), turned({0, 1, 0}), {}};
  if (values.size() > 6)
    pose.fov = values[6];
  return pose;
}

/// Whether the matrices act on row vectors, with the translation in the last row as Houdini and USD
/// have it, and not in the last column, as Blender has it.
bool acts_on_rows(const std::vector<CameraKey>& keys, const std::string& path) {
  bool rows = false, columns = false;
  for (const CameraKey& key : keys) {
    for (const std::size_t i : {12, 13, 14})
      rows = rows || key.values[i] != 0;
    for (const std::size_t i : {3, 7, 11})
      columns = columns || key.values[i] != 0;
    if (key.values[15] != 1 || (rows && columns))
      fail(path, key.line,
           "must be a matrix with a last row, or in all lines a last column, of 0 0 0 1");
  }
  return rows;
}

CameraPose matrix_pose(const CameraKey& key, bool rows, const std::string& path) {
  const auto column = [&](std::size_t i) {
    const std::vector<double>& m = key.values;
    return rows ? Vec3d{m[4 * i], m[4 * i + 1], m[4 * i + 2]} : Vec3d{m[i], m[4 + i], m[8 + i]};
  };
  const double determinant = dot(column(0), cross(column(1), column(2)));
  const double size = length(column(0)) * length(column(1)) * length(column(2));
  if (!(determinant > 1e-6 * size))
    fail(path, key.line, "must be a rotation (with scales above 0), neither mirrored nor flat");
  return {column(3), -normalize(column(2)), normalize(column(1)), {}};
}

Vec3d turned_world(const Vec3d& v, FileAxes axes) {
  if (axes == FileAxes::y_up_to_z_up)
    return {v.x, -v.z, v.y};
  if (axes == FileAxes::z_up_to_y_up)
    return {v.x, v.z, -v.y};
  return v;
}

CameraFile::Track read_track(const CameraSettings& settings) {
  CameraFile::Track track;
  const bool gltf = is_gltf_file(settings.file);
  track.keys = gltf ? read_gltf(settings, track.fov) : read_lines(settings.file);
  track.matrices = track.keys.front().values.size() == matrix_numbers;
  track.rows = track.matrices && !gltf && acts_on_rows(track.keys, settings.file);
  return track;
}

/// Where the camera is between two keys: `share` of the way from one to the other.
CameraPose pose_between(const CameraSettings& settings, const CameraFile::Track& track,
                        const CameraKey& before, const CameraKey& after, double share) {
  const std::string& path = settings.file;
  if (track.matrices) {
    const CameraPose a = matrix_pose(before, track.rows, path),
                     b = matrix_pose(after, track.rows, path);
    const auto mix = [&](const Vec3d& x, const Vec3d& y) { return x + (y - x) * share; };
    return {
        mix(a.position, b.position), mix(a.forward, b.forward), mix(a.up, b.up), track.fov, 0, 0};
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < after.values.size(); ++i)
    values.push_back(before.values[i] + (after.values[i] - before.values[i]) * share);
  const CameraPose pose = chan_pose(values, settings.file_rotation);
  if (pose.fov && !(*pose.fov > 0 && *pose.fov < 180))
    fail(path, after.line,
         fmt::format("must have a field of view in (0, 180) degrees, got {:g}", *pose.fov));
  return pose;
}

} // namespace

CameraPose CameraFile::pose_at(const CameraSettings& settings, double time) {
  std::shared_ptr<const Track> track;
  {
    const std::string identity =
        fmt::format("{}|{}|{}", model_identity(settings.file), settings.name, settings.file_fps);
    const std::scoped_lock lock(mutex_);
    if (!track_ || identity != identity_)
      track_ = std::make_shared<const Track>(read_track(settings));
    identity_ = identity;
    track = track_;
  }
  const std::vector<Key>& keys = track->keys;
  const auto next =
      std::lower_bound(keys.begin(), keys.end(), time,
                       [](const Key& key, double frame) { return key.frame < frame; });
  const Key& after = next == keys.end() ? keys.back() : *next;
  const Key& before = next == keys.begin() || next == keys.end() ? after : *(next - 1);
  const double width = after.frame - before.frame;
  CameraPose pose =
      pose_between(settings, *track, before, after, width > 0 ? (time - before.frame) / width : 1);
  for (Vec3d* v : {&pose.position, &pose.forward, &pose.up})
    *v = turned_world(*v, settings.file_axes);
  pose.forward = normalize(pose.forward);
  pose.up = normalize(pose.up);
  pose.first = keys.front().frame;
  pose.last = keys.back().frame;
  return pose;
}

} // namespace vdbeam
