#pragma once

#include <map>
#include <string>
#include <vector>

namespace vdbeam {

/// One named plane of floats, row-major from the top left.
struct ImageChannel {
  std::string name;         ///< EXR name: "R", "volume_direct.R", "volume_Z", ...
  std::vector<float> data;  ///< width * height values
  bool half = true;         ///< stored as half in the file
};

/// An image as it goes to or comes from a file.
struct Image {
  int width = 0;
  int height = 0;
  /// Where the picture lies in the whole one, for one that was cut out: its top left pixel, and the
  /// whole one's size (0: it is whole).
  int x = 0, y = 0;
  int full_width = 0, full_height = 0;
  std::vector<ImageChannel> channels;
  std::map<std::string, std::string> metadata;       ///< string attributes
  std::map<std::string, double> numbers;             ///< double attributes (report values)
  std::map<std::string, std::vector<float>> matrices; ///< 16 floats, row-major (worldToCamera, ...)

  const ImageChannel* find(const std::string& name) const {
    for (const ImageChannel& channel : channels)
      if (channel.name == name)
        return &channel;
    return nullptr;
  }
};

} // namespace vdbeam
