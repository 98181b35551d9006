#include "film/layers.h"

#include "layers/plane_layers.h"
#include "text/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace vdbeam {
namespace {

const std::vector<std::string>& usual_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{
        "beauty",          "alpha",   "volume",     "volume_direct", "volume_indirect",
        "volume_emission", "depth",   "background", "transmittance", "variance",
        "error",           "samples", "lights",     "volumes",       "cryptomatte"};
    const std::vector<std::string> planes = plane_layer_names();
    all.insert(all.end(), planes.begin(), planes.end());
    return all;
  }();
  return names;
}

bool is_usual(const std::string& layer) {
  const std::vector<std::string>& names = usual_names();
  return std::find(names.begin(), names.end(), layer) != names.end();
}

/// In the order of Compression.
constexpr const char* compression_names[] = {"zip", "zips", "piz", "rle", "none", "dwaa", "dwab"};
const char* compression_name(Compression compression) {
  return compression_names[static_cast<std::size_t>(compression)];
}

/// The part of a file in which a channel is, where layers have parts of their own.
std::string part_of(const std::string& channel) {
  const auto dot = channel.rfind('.');
  return dot == std::string::npos ? "rgba" : channel.substr(0, dot);
}

/// Whether a channel of the picture belongs to a layer.
bool holds(const std::string& layer, const std::string& channel) {
  if (layer == "beauty")
    return channel == "R" || channel == "G" || channel == "B";
  if (layer == "alpha")
    return channel == "A";
  if (layer == "lights")
    return channel.starts_with("light_");
  if (layer == "volumes")
    return plane_layer_of(channel).name == "volume_" && channel.starts_with("volume_") &&
           !is_usual(channel.substr(0, channel.rfind('.')));
  if (layer == "cryptomatte")
    return channel.starts_with("CryptoObject");
  return channel.starts_with(layer + ".");
}

} // namespace

std::string why_no_layer(const std::string& name, const std::vector<std::string>& others) {
  std::vector<std::string> names = usual_names();
  names.insert(names.end(), others.begin(), others.end());
  if (std::find(names.begin(), names.end(), name) != names.end())
    return "";
  const auto near = nearest_word(name, names);
  return fmt::format("must be {}, got \"{}\"{}", join_words(names, "or"), name,
                     near ? "; did you mean " + *near + "?" : "");
}

Image develop_layers(const Film& film, const std::vector<LayerSettings>& layers) {
  Image all = film.develop();
  if (layers.empty())
    return all;
  for (const LayerSettings& layer : layers)
    film.add_layer(layer.name, all);
  Image image = all;
  image.channels.clear();
  std::map<std::string, std::string> compressions; // of layers' parts
  for (ImageChannel& channel : all.channels) {
    const auto wanted = std::find_if(layers.begin(), layers.end(), [&](const auto& layer) {
      return holds(layer.name, channel.name);
    });
    if (wanted == layers.end() && !holds("beauty", channel.name))
      continue;
    if (wanted != layers.end() && wanted->precision != LayerPrecision::automatic)
      channel.half = wanted->precision == LayerPrecision::half;
    if (wanted != layers.end() && wanted->compression)
      compressions[part_of(channel.name)] = compression_name(*wanted->compression);
    image.channels.push_back(std::move(channel));
  }
  for (const auto& [part, compression] : compressions)
    image.metadata["vdbeam:partCompression"] += part + ":" + compression + " ";
  if (!image.find("CryptoObject00.R"))
    std::erase_if(image.metadata, [](const auto& attribute) {
      return attribute.first.starts_with("cryptomatte/");
    });
  return image;
}

std::string layers_text(const std::vector<LayerSettings>& layers) {
  std::string text;
  for (const LayerSettings& layer : layers)
    text += fmt::format("{}{}:{}{}", text.empty() ? "" : " ", layer.name,
                        static_cast<int>(layer.precision),
                        layer.compression ? compression_name(*layer.compression) : "");
  return text;
}

std::vector<LayerSettings> layers_of_text(const std::string& text) {
  std::vector<LayerSettings> layers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto colon = word.find(':');
    if (colon == std::string::npos || colon + 2 > word.size())
      continue;
    const int precision = std::clamp(word[colon + 1] - '0', 0, 2);
    LayerSettings& layer = layers.emplace_back();
    layer.name = word.substr(0, colon);
    layer.precision = static_cast<LayerPrecision>(precision);
    for (std::size_t i = 0; i < std::size(compression_names); ++i)
      if (word.substr(colon + 2) == compression_names[i])
        layer.compression = static_cast<Compression>(i);
  }
  return layers;
}

} // namespace vdbeam
