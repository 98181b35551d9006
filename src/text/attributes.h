#pragma once

#include <map>
#include <optional>
#include <string>

namespace vdbeam {

/// "name = text; name = text" as a map. What is not of that form is left out.
std::map<std::string, std::string> parse_attributes(const std::string& text);
/// What is wrong with such a text as attributes of an image, or nothing: names are made of letters,
/// digits, _, . and -, and are none that OpenEXR or vdbeam uses.
std::string why_no_attributes(const std::string& text);

/// The frame that a time code "hh:mm:ss:ff" counts, at a frame rate: 0 for an empty
/// one; nullopt for what is not one.
std::optional<int> frames_of_time_code(const std::string& text, int frames_per_second);

} // namespace vdbeam
