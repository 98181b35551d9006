#include "scene/scene_reader.h"
#include "scene/toml_value.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// a after b, both row-major 3x4 matrices.
std::array<double, 12> after(const std::array<double, 12>& a, const std::array<double, 12>& b) {
  std::array<double, 12> result{};
  for (std::size_t row = 0; row < 12; row += 4)
    for (std::size_t column = 0; column < 4; ++column) {
      result[row + column] = column == 3 ? a[row + 3] : 0;
      for (std::size_t k = 0; k < 3; ++k)
        result[row + column] += a[row + k] * b[4 * k + column];
    }
  return result;
}

std::vector<double> numbers_of(const toml::node& node, const std::string& path) {
  const auto* list = node.as_array();
  std::vector<double> numbers;
  for (std::size_t i = 0; list && i < list->size(); ++i)
    if (const auto number = (*list)[i].value<double>(); number && std::isfinite(*number))
      numbers.push_back(*number);
  if (!list || numbers.size() != list->size())
    throw InputError(fmt::format("{}: {} must be a list of numbers, e.g. [1, 0, 2.5], got {}",
                                 location_of(node), path, node_text(node)));
  return numbers;
}

} // namespace

/// Rows that stand in the scene file; their columns may follow, so that they are read at the end.
void SceneReader::read_rows(std::size_t index, const toml::node& node) {
  const std::string path = fmt::format("instance.{}.rows", index);
  if (!node.as_array())
    throw InputError(
        fmt::format("{}: {} must be a list of rows, e.g. [[0, 0, 0], [5, 0, 0]], got {}",
                    location_of(node), path, node_text(node)));
  rows_.resize(index + 1);
  rows_[index] = &node;
  locations_[path] = location_of(node);
}

std::vector<InstanceRow> SceneReader::rows_of(std::size_t index) const {
  const InstanceSettings& settings = scene_.instances[index];
  const std::string item = fmt::format("instance.{}", index);
  const toml::node* inline_rows = index < rows_.size() ? rows_[index] : nullptr;
  if (settings.file.empty() == (inline_rows == nullptr))
    throw InputError(fmt::format("{}: {} needs {}", locate(item + ".volume"), item,
                                 inline_rows ? "rows or a file, not both" : "rows or a file"));
  if (!inline_rows) {
    try {
      return read_instance_file(settings.file, settings.columns);
    } catch (const InputError& problem) {
      throw InputError(
          fmt::format("{}: {}.file: {}", locate(item + ".file"), item, problem.what()));
    }
  }
  std::vector<InstanceRow> rows;
  std::string path = item + ".columns", place = locate(path);
  try {
    const InstanceColumns columns(settings.columns);
    for (const toml::node& row : *inline_rows->as_array()) {
      path = fmt::format("{}.rows.{}", item, rows.size());
      place = location_of(row);
      rows.push_back(columns.row(numbers_of(row, path)));
    }
  } catch (const InputError& problem) {
    const std::string what = problem.what();
    throw InputError(
        what.starts_with(place) ? what : one_line(fmt::format("{}: {} {}", place, path, what)));
  }
  return rows;
}

/// Repeats volumes at the places of their instances. The first one takes the volume's number, the
/// others come after all volumes of the file, so that these keep theirs.
void SceneReader::place_instances() {
  const std::size_t count = scene_.volumes.size();
  std::vector<bool> placed(count, false);
  const std::vector<VolumeSettings> of_file = scene_.volumes;
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const std::string& name = scene_.instances[i].volume;
    const auto found =
        std::find_if(of_file.begin(), of_file.end(), [&](const VolumeSettings& volume) {
          return !name.empty() && volume.name == name;
        });
    if (found == of_file.end())
      fail_unnamed(i);
    const auto v = static_cast<std::size_t>(found - of_file.begin());
    const std::vector<InstanceRow> rows = rows_of(i);
    if (scene_.volumes.size() + rows.size() > count + most_instances)
      throw InputError(fmt::format("{}: instance.{} has {}: a scene may have {}",
                                   locate(fmt::format("instance.{}.volume", i)), i,
                                   count_text(rows.size(), "row"),
                                   count_text(most_instances, "instance")));
    for (const InstanceRow& row : rows) {
      VolumeSettings volume = *found;
      volume.transform = after(row.transform, found->transform);
      volume.extinction *= row.density;
      if (volume.emission.glows()) // or the scale would be a key without effect
        volume.emission.scale *= row.density;
      if (placed[v])
        scene_.volumes.push_back(std::move(volume));
      else
        scene_.volumes[v] = std::move(volume);
      placed[v] = true;
    }
    if (!placed[v]) // so far it has no place
      scene_.volumes[v].present = false;
  }
}

/// No volume has the name that a table of instances gives.
void SceneReader::fail_unnamed(std::size_t index) const {
  const std::string path = fmt::format("instance.{}.volume", index);
  std::vector<std::string> names;
  for (const VolumeSettings& volume : scene_.volumes)
    if (!volume.name.empty() && std::find(names.begin(), names.end(), volume.name) == names.end())
      names.push_back(volume.name);
  const std::string& name = scene_.instances[index].volume;
  const auto near = nearest_word(name, names);
  throw InputError(one_line(
      fmt::format("{}: {}: there is no [[volume]] with name = \"{}\"{}", locate(path), path, name,
                  near            ? "; did you mean " + *near + "?"
                  : names.empty() ? "; give one a name"
                                  : "; their names are " + join_words(names, "and"))));
}

} // namespace vdbeam
