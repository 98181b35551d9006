#pragma once

#include "keys/scene_keys.h"

#include <span>
#include <string>
#include <string_view>

namespace vdbeam {

/// Names of a key or a value in other programs.
struct KeySynonym {
  SceneSection section;
  std::string_view word; ///< in small letters
  /// Its equivalent here: keys of the same table ("g"), or with their table ("render.passes"),
  /// separated by spaces. A test checks that they exist.
  std::string_view keys;
  /// The remedy in words; empty: "did you mean" and the keys.
  std::string_view remedy;
};

/// Names of a key's value in other programs.
struct ValueSynonym {
  SceneSection section;
  std::string_view key, word;
  std::string_view value;  ///< the value here; empty where there is none
  std::string_view remedy; ///< what to write instead, where no value is meant
};

std::span<const KeySynonym> key_synonyms();
std::span<const ValueSynonym> value_synonyms();

/// "; did you mean render.passes?" or other words for a key that the table does not have; empty
/// where nothing is known about the word.
std::string synonym_remedy(SceneSection section, const std::string& word);

/// The path of the key that a word of the picture, the render or the camera means ("samples":
/// "render.passes"); empty where it is none of the synonyms.
std::string key_meant_by(const std::string& word);

/// "; did you mean distant?" for a value of a choice; empty where nothing is known.
std::string value_remedy(SceneSection section, const std::string& key, const std::string& word);

} // namespace vdbeam
