#pragma once

#include "vdbeam/color_space.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace vdbeam {

/// One named plane of floats, row-major from the top left.
struct ImageChannel {
  std::string name;        ///< EXR name: "R", "volume_direct.R", "depth.Z", ...
  std::vector<float> data; ///< width * height values
  bool half = true;        ///< stored as half in the file
};

/// An image as it goes to or comes from a file.
struct Image {
  int width = 0;
  int height = 0;
  /// For a region of an image: its top left pixel in the whole image, and the size of the whole
  /// image (0: this is the whole image).
  int x = 0, y = 0;
  int full_width = 0, full_height = 0;
  /// Primaries of R, G and B in every layer; nullopt if they are not linear or unknown.
  std::optional<Chromaticities> primaries = Chromaticities();
  std::vector<ImageChannel> channels;
  /// String attributes; "timeCode" ("01:02:03:04") becomes one of OpenEXR's own type.
  std::map<std::string, std::string> metadata;
  std::map<std::string, double> numbers; ///< double attributes, but for those named in `integers`
  std::set<std::string> integers;        ///< numbers that are whole
  /// 16 floats, row-major (worldToCamera, ...), or the 3 of a point.
  std::map<std::string, std::vector<float>> matrices;

  const ImageChannel* find(const std::string& name) const {
    for (const ImageChannel& channel : channels)
      if (channel.name == name)
        return &channel;
    return nullptr;
  }
};

} // namespace vdbeam
