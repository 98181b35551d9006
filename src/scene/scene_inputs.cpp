#include "scene/scene_inputs.h"

#include "geometry/gltf/gltf_files.h"
#include "machine/input_file.h"
#include "scene/toml_value.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

constexpr std::uint64_t gib = std::uint64_t(1) << 30;

/// Checks of a file without reading it: larger ones could not be held in memory, and a
/// file with holes may claim any size.
struct InputRule {
  InputKind kind;
  const char* files; ///< for messages
  std::uint64_t most_bytes;
};
constexpr InputRule rules[] = {
    {InputKind::volume, "VDB files", 256 * gib},
    {InputKind::picture, "pictures", 16 * gib},
    {InputKind::mesh, "mesh files", 16 * gib},
    {InputKind::camera, "camera files", 16 * gib},
    {InputKind::profile, "photometric files", 16 << 20},
    {InputKind::instances, "files of instances", 256 << 20},
};

/// Calls visit(table, index) for each table of a section.
template <class Visit>
void for_each_table(const toml::table& root, SceneSection section, const Visit& visit) {
  const std::string name = section_name(section);
  const std::size_t dot = name.find('.');
  const std::string inner = dot == std::string::npos ? "" : name.substr(dot + 1);
  const auto visit_item = [&](const toml::node& item, std::size_t index) {
    const toml::table* table = item.as_table();
    if (table && !inner.empty())
      table = table->get_as<toml::table>(inner);
    if (table)
      visit(*table, index);
  };
  const toml::node* node = root.get(name.substr(0, dot));
  if (const auto* list = node ? node->as_array() : nullptr)
    for (std::size_t i = 0; i < list->size(); ++i)
      visit_item((*list)[i], i);
  else if (node)
    visit_item(*node, 0);
}

bool is_model(InputKind kind) {
  return kind == InputKind::mesh || kind == InputKind::camera;
}

} // namespace

std::vector<SceneFile> scene_files(const toml::table& root, const std::filesystem::path& folder) {
  std::vector<SceneFile> files;
  for (const SceneKey& key : scene_keys()) {
    if (key.kind != KeyKind::file)
      continue;
    for_each_table(root, key.section, [&](const toml::table& table, std::size_t index) {
      const auto* file = table.get_as<std::string>(key.name);
      if (!file || file->get().empty())
        return;
      const std::string path = is_override(*file) ? file->get() : (folder / file->get()).string();
      files.push_back({key_path(key, index), path, location_of(*file), key.input});
    });
  }
  return files;
}

void check_input(InputKind kind, const std::string& path) {
  const std::uint64_t bytes = check_input_file(path, EmptyFile::accepted);
  for (const InputRule& rule : rules)
    if (rule.kind == kind && bytes > rule.most_bytes)
      throw InputError(fmt::format("{}: has {}; {} may have {}", one_line(path),
                                   format_bytes(static_cast<double>(bytes)), rule.files,
                                   format_bytes(static_cast<double>(rule.most_bytes))));
  constexpr std::string_view magic = " BDV";
  if (kind == InputKind::volume && bytes > 0 && read_start(path, magic.size()) != magic)
    throw InputError(one_line(path) + ": is not a VDB file");
}

void check_named_inputs(InputKind kind, const std::string& path) {
  if (is_model(kind))
    bytes_of_gltf_files(path);
}

std::vector<std::string> files_named_by(InputKind kind, const std::string& path) {
  return is_model(kind) ? files_named_by_model(path) : std::vector<std::string>();
}

} // namespace vdbeam
