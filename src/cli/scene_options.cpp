#include "cli/scene_options.h"

#include "keys/key_access.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace vdbeam::cli {
namespace {

/// Any of these on the command line replaces the whole stop rule of the file.
constexpr std::array stop_keys{"render.passes", "render.time", "render.target_error"};

bool is_stop_key(const std::string& key) {
  return std::find(stop_keys.begin(), stop_keys.end(), key) != stop_keys.end();
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// The options that set one key, in the order of --help.
const std::vector<ShorthandRow>& shorthand_table() {
  static const std::vector<ShorthandRow> table{
      {"--passes", "render.passes", "N", "Number of passes"},
      {"--time", "render.time", "T", "Time limit of a frame: seconds, or like 90s, 5m, 1h30m"},
      {"--target-error", "render.target_error", "E", "Stop at this estimated error (MRSE)"},
      {"--min-passes", "render.min_passes", "N",
       "Fewest passes before --target-error may end a frame"},
      {"--estimator", "render.estimator", "NAME", join_words(choice_names<EstimatorType>(), "or")},
      {"--clamp", "render.clamp", "L",
       "Clamp the pixels of each pass to this radiance; the report gives the light removed"},
      {"--seed", "render.seed", "N", "Seed of the random numbers"},
      {"--threads", "render.threads", "N", "Number of threads; does not change the image"}};
  return table;
}

} // namespace

int choose_frame(const std::optional<int>& asked, const SceneDocument& document) {
  if (asked)
    return *asked;
  const std::vector<int> there = document.frames_on_disk();
  return document.has_frame_pattern() && !there.empty() ? there.front() : 1;
}

std::string option_for_key(const std::string& key) {
  if (key == "image.width" || key == "image.height")
    return "--resolution WxH";
  for (const ShorthandRow& row : shorthand_table())
    if (row.key == key)
      return row.option;
  return fmt::format("--set {}=VALUE", key);
}

void SceneOptions::declare_shorthand(CLI::App& app, const ShorthandRow& row) {
  shorthands_.push_back({row.option, row.key, {}});
  const std::size_t index = shorthands_.size() - 1;
  app.add_option_function<std::string>(
         row.option, [this, index](const std::string& value) { shorthands_[index].value = value; },
         row.description)
      ->option_text(row.value)
      ->group(is_stop_key(row.key) || row.key == "render.min_passes" ? "When to stop" : "Scene");
}

void SceneOptions::declare(CLI::App& app) {
  app.add_option("scene", path_, "Scene file, or a VDB (#### for the frame number)")
      ->required()
      ->option_text("SCENE|VDB");
  for (const ShorthandRow& row : shorthand_table())
    declare_shorthand(app, row);
  app.add_option("--resolution", resolution_, "Size of the image in pixels")
      ->option_text("WxH")
      ->group("Scene");
  app.add_option("--set", sets_, "Set any key of the scene; may be repeated")
      ->option_text("KEY=VALUE")
      ->take_all()
      ->group("Scene")
      ->allow_extra_args(false);
}

void SceneOptions::add_resolution(std::vector<Override>& overrides) const {
  if (resolution_.empty())
    return;
  const std::size_t cross = resolution_.find_first_of("xX");
  const std::string width = resolution_.substr(0, cross);
  const std::string height = cross == std::string::npos ? "" : resolution_.substr(cross + 1);
  const std::string origin = "--resolution " + resolution_;
  if (!is_number(width) || !is_number(height))
    throw InputError(one_line(origin + ": must look like 640x360"));
  // TOML has no leading zeros.
  overrides.push_back({"image.width", std::to_string(std::stoi(width)), origin});
  overrides.push_back({"image.height", std::to_string(std::stoi(height)), origin});
}

SceneDocument SceneOptions::open() const {
  std::vector<Override> overrides;
  const auto is_stop_rule = [](const Shorthand& s) {
    return !s.value.empty() && is_stop_key(s.key);
  };
  if (std::any_of(shorthands_.begin(), shorthands_.end(), is_stop_rule))
    for (const char* key : stop_keys)
      overrides.push_back({key, "none", "the stop rule"});
  for (const Shorthand& shorthand : shorthands_)
    if (!shorthand.value.empty())
      overrides.push_back(
          {shorthand.key, shorthand.value, shorthand.option + " " + shorthand.value});
  add_resolution(overrides);
  for (const std::string& text : sets_)
    overrides.push_back(parse_override(text));
  return SceneDocument(path_, overrides);
}

std::vector<std::string> SceneOptions::words() const {
  std::vector<std::string> words;
  for (const Shorthand& shorthand : shorthands_)
    if (!shorthand.value.empty())
      words.push_back(shorthand.option + "=" + shorthand.value);
  if (!resolution_.empty())
    words.push_back("--resolution=" + resolution_);
  for (const std::string& text : sets_)
    words.push_back("--set=" + text);
  return words;
}

} // namespace vdbeam::cli
