#include "layers/plane_layers.h"

#include "layers/scene_objects.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace vdbeam {
namespace {

constexpr float far_away = 1e10f; // as the layer `depth` has it

constexpr std::array<PlaneLayer, 10> layers{{{"depth_near", "Z", true, false, far_away},
                                             {"depth_far", "Z", true, false, far_away},
                                             {"position", "XYZ", true},
                                             {"motion", "XY", true},
                                             {"density_gradient", "XYZ", true},
                                             {"denoising_albedo", "BGR", false, true},
                                             {"denoising_normal", "XYZ", false, true},
                                             {"holdout", "Y", false, true},
                                             {"shadow", "BGR", false, true},
                                             {"catcher_light", "BGR", false, true}}};
constexpr PlaneLayer volume_layer{"volume_", "RGBA", false, true};

} // namespace

const PlaneLayer& plane_layer_of(std::string_view channel) {
  const std::string_view name = channel.substr(0, channel.rfind('.'));
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [&](const PlaneLayer& layer) { return layer.name == name; });
  return found == layers.end() ? volume_layer : *found;
}

std::vector<std::string> plane_layer_names() {
  std::vector<std::string> names;
  for (const PlaneLayer& layer : layers)
    names.emplace_back(layer.name);
  return names;
}

std::vector<std::string> volume_layer_names(const Scene& scene) {
  const SceneObjects objects = scene_objects(scene);
  std::vector<std::string> names;
  for (const std::size_t object : objects.of_volume)
    names.push_back(std::string(volume_layer.name) + objects.names[object]);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string why_no_volume_layer(const std::string& volume) {
  const bool plain = std::all_of(volume.begin(), volume.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  if (plain && volume != "direct" && volume != "indirect" && volume != "emission")
    return "";
  return "must be made of letters, digits, _ and -, and not be direct, indirect or emission, since "
         "its layer is asked for; got \"" +
         volume + "\"";
}

bool asks_for_layer(const Scene& scene, std::string_view name) {
  return std::any_of(scene.layers.begin(), scene.layers.end(),
                     [&](const LayerSettings& layer) { return layer.name == name; });
}

std::vector<std::string> plane_names(const Scene& scene) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& layer, std::string_view channels) {
    for (const char channel : channels)
      names.push_back(layer + "." + channel);
  };
  for (const PlaneLayer& layer : layers)
    if (asks_for_layer(scene, layer.name))
      add(std::string(layer.name), layer.channels);
  for (const std::string& name : volume_layer_names(scene))
    if (asks_for_layer(scene, "volumes") || asks_for_layer(scene, name))
      add(name, volume_layer.channels);
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace vdbeam
