#pragma once

#include "scene/scene_document.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// An option that sets one key of the scene.
struct ShorthandRow {
  std::string option, key, value, description;
};

/// How the command line sets a key: "--passes" for "render.passes", "--set image.fps=VALUE" for one
/// that has no option of its own.
std::string option_for_key(const std::string& key);

/// The frame of a command that shows one: `asked`, else the first of a sequence on disk, else 1.
int choose_frame(const std::optional<int>& asked, const SceneDocument& document);

/// The options that name a scene and change it, shared by the commands that take one.
class SceneOptions {
public:
  /// Declares SCENE, --set and, for commands that render, the shorthands of single keys.
  void declare(CLI::App& app);

  const std::string& path() const { return path_; }
  /// Reads the scene with everything the command line changes. Throws InputError.
  SceneDocument open() const;
  /// The words of a command line that change the scene in the same way; the scene is not among
  /// them.
  std::vector<std::string> words() const;

private:
  void declare_shorthand(CLI::App& app, const ShorthandRow& row);
  void add_resolution(std::vector<Override>& overrides) const;

  struct Shorthand {
    std::string option, key;
    std::string value; ///< empty: not given
  };
  std::string path_, resolution_;
  std::vector<std::string> sets_;
  std::vector<Shorthand> shorthands_;
};

} // namespace vdbeam::cli
