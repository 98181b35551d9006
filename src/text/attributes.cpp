#include "text/attributes.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <sstream>

namespace vdbeam {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\n"), last = text.find_last_not_of(" \t\n");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Attributes of every EXR, or that vdbeam writes.
constexpr const char* taken[] = {"channels",
                                 "compression",
                                 "dataWindow",
                                 "displayWindow",
                                 "lineOrder",
                                 "pixelAspectRatio",
                                 "screenWindowWidth",
                                 "screenWindowCenter",
                                 "tiles",
                                 "name",
                                 "type",
                                 "version",
                                 "chunkCount",
                                 "view",
                                 "multiView",
                                 "chromaticities",
                                 "framesPerSecond",
                                 "timeCode",
                                 "capDate",
                                 "utcOffset",
                                 "worldToCamera",
                                 "worldToNDC",
                                 "software",
                                 "preview",
                                 "envmap",
                                 "maxSamplesPerPixel"};

} // namespace

std::map<std::string, std::string> parse_attributes(const std::string& text) {
  std::map<std::string, std::string> attributes;
  std::istringstream pairs(text);
  for (std::string pair; std::getline(pairs, pair, ';');)
    if (const auto equals = pair.find('='); equals != std::string::npos)
      attributes[trimmed(pair.substr(0, equals))] = trimmed(pair.substr(equals + 1));
  return attributes;
}

std::string why_no_attributes(const std::string& text) {
  std::istringstream pairs(text);
  for (std::string pair; std::getline(pairs, pair, ';');)
    if (!trimmed(pair).empty() && pair.find('=') == std::string::npos)
      return "must be \"name = text; name = text\", got \"" + trimmed(pair) + "\"";
  for (const auto& [name, value] : parse_attributes(text)) {
    const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '.' || c == '-';
    });
    if (!plain)
      return "must have names of letters, digits, _, . and -, got \"" + name + "\"";
    if (std::find(std::begin(taken), std::end(taken), name) != std::end(taken))
      return "must not name \"" + name + "\", which every image has its own of";
  }
  return "";
}

std::optional<int> frames_of_time_code(const std::string& text, int frames_per_second) {
  if (text.empty())
    return 0;
  int part[4] = {}, length = 0;
  const int count = std::sscanf(text.c_str(), "%2d:%2d:%2d:%2d%n", &part[0], &part[1], &part[2],
                                &part[3], &length);
  if (count != 4 || static_cast<std::size_t>(length) != text.size() ||
      std::min({part[0], part[1], part[2], part[3]}) < 0 || part[0] > 23 || part[1] > 59 ||
      part[2] > 59 || part[3] >= frames_per_second)
    return std::nullopt;
  return ((part[0] * 60 + part[1]) * 60 + part[2]) * frames_per_second + part[3];
}

} // namespace vdbeam
