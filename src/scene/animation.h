#pragma once

#include "keys/scene_keys.h"

#include <toml++/toml.h>

namespace vdbeam {

/// The value of a key at a time [frames]: as written, or interpolated where it is given as `{ keys
/// =
/// [[frame, value], ...], interpolation = "linear" | "smooth" }`. Before the first and after the
/// last of the keys their values hold. Smooth curves are piecewise cubic with the slopes of Fritsch
/// and Butland (1984): they pass through the keys without overshooting them, so that a key's range
/// holds between them too. Throws InputError as read_key_value.
KeyValue read_value_at(const SceneKey& key, const std::string& path, const toml::node& node,
                       double time);

} // namespace vdbeam
