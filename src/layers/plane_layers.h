#pragma once

#include "vdbeam/scene.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vdbeam {

/// A layer that passes hold planes for only where a [[layer]] asks for it
/// (docs/reference/output.md). Each of its planes is named as the channel that the film makes of
/// it, "position.X".
struct PlaneLayer {
  std::string_view name, channels;
  bool of_opacity = false; ///< a mean of what makes the pixel opaque, weighted by that opacity
  bool half = false;       ///< halves can hold it
  float empty = 0;         ///< where nothing is opaque
};

/// The layer of a plane; that of a volume has the name "volume_".
const PlaneLayer& plane_layer_of(std::string_view channel);

/// Names of the layers of this file except those of volumes.
std::vector<std::string> plane_layer_names();
/// The layers of the volumes of a scene, one for each name that they have.
std::vector<std::string> volume_layer_names(const Scene& scene);
/// What is wrong with the name of a volume whose layer is asked for; empty: nothing.
std::string why_no_volume_layer(const std::string& volume);

/// The scene's layers include this one.
bool asks_for_layer(const Scene& scene, std::string_view name);
/// The planes that passes are to hold, in ascending order.
std::vector<std::string> plane_names(const Scene& scene);

} // namespace vdbeam
