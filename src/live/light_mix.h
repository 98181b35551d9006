#pragma once

#include "vdbeam/image.h"
#include "vdbeam/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// Images of single lights, from which an image under other strengths of the lights is mixed:
/// light adds up.
class LightMix {
public:
  /// The scene with a group for each light, each surface that shines and all volumes that glow, and
  /// without groups, layers, deep samples and settings of files of its own. It has no groups where
  /// they are impossible (render.clamp) or too many.
  static Scene with_groups(Scene scene);

  /// Factors, by group name, that make images of `rendered` (with_groups) images of `edited`;
  /// nothing where factors cannot do that.
  static std::optional<LightMix> between(const Scene& rendered, const Scene& edited);

  bool changes_nothing() const { return factors_.empty(); }
  /// R, G, B and A of an image with light groups, under the new strengths. Nothing where a light
  /// that has changed has no image of its own, as in a quick look.
  std::optional<Image> apply(const Image& image) const;

private:
  struct Factor {
    std::string group;
    Rgb value;
  };
  std::vector<Factor> factors_; ///< other than 1
};

} // namespace vdbeam
