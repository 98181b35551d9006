#pragma once

#include "keys/scene_keys.h"

#include <string>
#include <toml++/toml.h>

namespace vdbeam {

/// "cloud.toml:14" for a node of a file, "--set volume.0.extinction=80" for one of the command
/// line.
std::string location_of(const toml::node& node);
/// True for a value that came from the command line.
bool is_override(const toml::node& node);
/// Prefix that marks an option of the command line as the source, as opposed to a file.
std::string override_source(const std::string& origin);

/// A node as text for messages: `"beam"`, `1.2`, `[1, 2]`, `a table`; one line, not too long.
std::string node_text(const toml::node& node);

/// The node as a value of this key. Throws InputError where its type or range is not right.
/// `path` names the key in messages.
KeyValue read_key_value(const SceneKey& key, const std::string& path, const toml::node& node);

} // namespace vdbeam
