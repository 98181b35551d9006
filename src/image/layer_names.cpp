#include "image/layer_names.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

namespace vdbeam {
namespace {

/// A layer, "" being that of R, G, B and A; empty where a renderer has nothing like it.
struct LayerName {
  std::string_view ours, arnold, cycles;
};
constexpr LayerName layer_names[] = {{"volume_direct", "volume_direct", "VolumeDir"},
                                     {"volume_indirect", "volume_indirect", "VolumeInd"},
                                     {"volume_emission", "emission", "Emit"},
                                     {"background", "background", "Env"},
                                     {"depth", "", "Depth"}, // Arnold's is the channel Z itself
                                     {"depth_near", "volume_Z", ""},
                                     {"denoising_albedo", "albedo", "Denoising Albedo"},
                                     {"denoising_normal", "N", "Denoising Normal"},
                                     {"position", "P", "Position"},
                                     {"motion", "motionvector", "Vector"}};
constexpr std::string_view view_layer = "ViewLayer.";

/// The layer that Arnold or Cycles would write.
std::string renamed(const std::string& layer, bool arnold) {
  if (layer.starts_with("CryptoObject")) // which its attributes name
    return layer;
  std::string name = layer;
  for (const LayerName& row : layer_names)
    if (row.ours == layer && !(arnold ? row.arnold : row.cycles).empty())
      name = arnold ? row.arnold : row.cycles;
  if (layer.starts_with("light_"))
    name = (arnold ? "RGBA_" : "Combined_") + layer.substr(6);
  if (arnold)
    return name;
  return std::string(view_layer) + (layer.empty() ? "Combined" : name);
}

/// Cycles' vectors are two, each the way back in time, of pixels that count from the lower left:
/// from this frame to the one before, and from the one after to this. Both are those of a motion
/// that goes on as it is.
void reverse_motion(Image& image) {
  const std::string layer = std::string(view_layer) + "Vector.";
  for (const auto& [from, to] : {std::pair("X", "Z"), std::pair("Y", "W")}) {
    const auto channel =
        std::find_if(image.channels.begin(), image.channels.end(),
                     [&](const ImageChannel& c) { return c.name == layer + from; });
    if (channel == image.channels.end())
      continue;
    for (float& value : channel->data)
      value = -value;
    ImageChannel next = *channel;
    next.name = layer + to;
    image.channels.push_back(std::move(next));
  }
}

} // namespace

void rename_layers(Image& image, const std::string& renderer) {
  const bool arnold = renderer == "arnold";
  for (ImageChannel& channel : image.channels) {
    const auto dot = channel.name.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.name.substr(0, dot);
    const std::string last = channel.name.substr(dot == std::string::npos ? 0 : dot + 1);
    const std::string name = arnold && layer == "depth" ? "" : renamed(layer, arnold);
    channel.name = name.empty() ? last : name + "." + last;
  }
  if (!arnold)
    reverse_motion(image);
  // Parts are named as their layers are.
  const auto parts = image.metadata.find("vdbeam:partCompression");
  if (parts == image.metadata.end())
    return;
  std::istringstream pairs(std::exchange(parts->second, ""));
  for (std::string pair; pairs >> pair;) {
    const auto colon = pair.find(':');
    const std::string layer = pair.substr(0, colon);
    parts->second +=
        (layer == "rgba" && arnold ? layer : renamed(layer == "rgba" ? "" : layer, arnold)) +
        pair.substr(colon) + " ";
  }
}

void name_combined_rgba(Image& image) {
  if (image.find("R"))
    return;
  const std::string combined = std::string(view_layer) + "Combined.";
  for (ImageChannel& channel : image.channels)
    if (channel.name.starts_with(combined))
      channel.name = channel.name.substr(combined.size());
}

} // namespace vdbeam
