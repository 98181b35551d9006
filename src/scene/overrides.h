#pragma once

#include <string>
#include <toml++/toml.h>
#include <vector>

namespace vdbeam {

/// A value of the command line that replaces one of the scene file.
struct Override {
  std::string key;    ///< "volume.0.extinction"; the number may be left out where there is one
  std::string value;  ///< TOML, or a bare word that becomes a text
  std::string origin; ///< as the user wrote it, for messages: "--set volume.0.extinction=80"
};

/// Splits "key.path=value". Throws InputError.
Override parse_override(const std::string& text);

/// Puts the value into the tree; tables and new list entries are made on the way.
/// Throws InputError where the path does not lead anywhere.
void apply_override(toml::table& root, const Override& entry);

} // namespace vdbeam
