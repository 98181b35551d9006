#include "film/layers.h"

#include "text/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace vdbeam {
namespace {

const std::vector<std::string>& usual_names() {
  static const std::vector<std::string> names{"beauty",        "alpha",           "volume",
                                              "volume_direct", "volume_indirect", "volume_emission",
                                              "depth",         "background",      "transmittance",
                                              "variance",      "lights",          "cryptomatte"};
  return names;
}

/// Whether a channel of the picture belongs to a layer.
bool holds(const std::string& layer, const std::string& channel) {
  if (layer == "beauty")
    return channel == "R" || channel == "G" || channel == "B";
  if (layer == "alpha")
    return channel == "A";
  if (layer == "lights")
    return channel.starts_with("light_");
  if (layer == "cryptomatte")
    return channel.starts_with("CryptoObject");
  return channel.starts_with(layer + ".");
}

} // namespace

std::string why_no_layer(const std::string& name, const std::vector<std::string>& groups) {
  std::vector<std::string> names = usual_names();
  for (const std::string& group : groups)
    names.push_back("light_" + group);
  if (std::find(names.begin(), names.end(), name) != names.end())
    return "";
  return fmt::format("must be {}, got \"{}\"", join_words(names, "or"), name);
}

Image develop_layers(const Film& film, const std::vector<LayerSettings>& layers) {
  Image all = film.develop();
  if (layers.empty())
    return all;
  for (const LayerSettings& layer : layers)
    film.add_layer(layer.name, all);
  Image image = all;
  image.channels.clear();
  for (ImageChannel& channel : all.channels) {
    const auto wanted = std::find_if(layers.begin(), layers.end(), [&](const auto& layer) {
      return holds(layer.name, channel.name);
    });
    if (wanted == layers.end() && !holds("beauty", channel.name))
      continue;
    if (wanted != layers.end() && wanted->precision != LayerPrecision::automatic)
      channel.half = wanted->precision == LayerPrecision::half;
    image.channels.push_back(std::move(channel));
  }
  if (!image.find("CryptoObject00.R"))
    std::erase_if(image.metadata, [](const auto& attribute) {
      return attribute.first.starts_with("cryptomatte/");
    });
  return image;
}

std::string layers_text(const std::vector<LayerSettings>& layers) {
  std::string text;
  for (const LayerSettings& layer : layers)
    text += fmt::format("{}{}:{}", text.empty() ? "" : " ", layer.name,
                        static_cast<int>(layer.precision));
  return text;
}

std::vector<LayerSettings> layers_of_text(const std::string& text) {
  std::vector<LayerSettings> layers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto colon = word.find(':');
    if (colon == std::string::npos || colon + 2 != word.size())
      continue;
    const int precision = std::clamp(word.back() - '0', 0, 2);
    layers.push_back({word.substr(0, colon), static_cast<LayerPrecision>(precision)});
  }
  return layers;
}

} // namespace vdbeam
