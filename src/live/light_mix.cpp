#include "live/light_mix.h"

#include "lights/light_table.h"
#include "live/scene_changes.h"
#include "materials/material_table.h"
#include "volume/blackbody.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Groups take time and memory for every pixel.
constexpr std::size_t most_groups = 12;

std::string group_of_light(std::size_t i) {
  return fmt::format("light{}", i);
}
std::string group_of_mesh(std::size_t i) {
  return fmt::format("mesh{}", i);
}

/// Drops what shapes the file of a render, but no pixel of R, G, B and A.
void drop_outputs(Scene& scene) {
  const ImageSettings given = scene.image;
  scene.image = {.width = given.width,
                 .height = given.height,
                 .fps = {},
                 .pixel_aspect = given.pixel_aspect,
                 .overscan = given.overscan,
                 .filter = given.filter,
                 .filter_width = given.filter_width,
                 .working_space = given.working_space,
                 .output_space = given.output_space};
}

/// The scene with the groups and layers of another one, and without outputs of its own.
Scene with_groups_of(const Scene& other, Scene scene) {
  drop_outputs(scene);
  scene.layers = other.layers;
  for (std::size_t i = 0; i < std::min(scene.lights.size(), other.lights.size()); ++i)
    scene.lights[i].group = other.lights[i].group;
  for (std::size_t i = 0; i < std::min(scene.surfaces.size(), other.surfaces.size()); ++i)
    scene.surfaces[i].group = other.surfaces[i].group;
  return scene;
}

/// What scales the light of a source. Empty where that is not known.
std::optional<Rgb> strength(const LightSettings& light) {
  const LightSettings own = tinted(light);
  const auto& keys = light_kind(light.type).keys;
  const auto takes = [&](std::string_view key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (takes("power") && own.power)
    return own.power;
  if (takes("intensity"))
    return own.intensity;
  if (takes("irradiance"))
    return own.irradiance;
  if (takes("radiance"))
    return own.radiance;
  return std::nullopt;
}

std::optional<Rgb> strength(const MaterialSettings& material) {
  return material.power.value_or(material.radiance) *
         light_tint(material.kelvin, material.exposure, material.color_space);
}

/// What a source's image is multiplied by; nothing where it has no light in a channel that is asked
/// for.
std::optional<Rgb> factor(const std::optional<Rgb>& before, const std::optional<Rgb>& after) {
  if (!before || !after)
    return std::nullopt;
  Rgb result(1);
  for (int c = 0; c < 3; ++c) {
    if ((*before)[c] == (*after)[c])
      continue;
    if (!((*before)[c] > 0))
      return std::nullopt;
    result[c] = (*after)[c] / (*before)[c];
  }
  return result;
}

/// "light.3.exposure" begins with "light.3." and ends with one of the names.
bool is_key_of(const std::string& path, const std::string& table,
               std::initializer_list<std::string_view> names) {
  if (!path.starts_with(table))
    return false;
  const std::string_view name = std::string_view(path).substr(table.size());
  return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

Scene LightMix::with_groups(Scene scene) {
  drop_outputs(scene);
  std::size_t shining = 0;
  bool catches_shadows = false; // whose alpha depends on all lights together
  for (SurfaceSettings& surface : scene.surfaces) {
    surface.group.clear();
    shining += shines(surface.material) ? 1 : 0;
    catches_shadows = catches_shadows || surface.material.type == MaterialType::shadow_catcher;
  }
  for (LightSettings& light : scene.lights)
    light.group.clear();
  scene.layers = {{"beauty"}, {"alpha"}};
  const std::size_t sources = scene.lights.size() + shining;
  if (scene.render.clamp || catches_shadows || sources == 0 || sources > most_groups)
    return scene;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    scene.lights[i].group = group_of_light(i);
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
    if (shines(scene.surfaces[i].material))
      scene.surfaces[i].group = group_of_mesh(i);
  scene.layers.push_back({"lights"});
  return scene;
}

std::optional<LightMix> LightMix::between(const Scene& rendered, const Scene& edited) {
  const auto is_strength = [&](const std::string& path, std::size_t lights, std::size_t meshes) {
    for (std::size_t i = 0; i < lights; ++i)
      if (is_key_of(path, fmt::format("light.{}.", i),
                    {"irradiance", "radiance", "intensity", "power", "kelvin", "exposure"}))
        return true;
    for (std::size_t i = 0; i < meshes; ++i)
      if (is_key_of(path, fmt::format("mesh.{}.material.", i),
                    {"radiance", "power", "kelvin", "exposure"}))
        return true;
    return false;
  };
  for (const std::string& path : changed_keys(rendered, with_groups_of(rendered, edited)))
    if (!is_strength(path, rendered.lights.size(), rendered.surfaces.size()))
      return std::nullopt;
  LightMix mix;
  const auto add = [&](const std::string& group, const std::optional<Rgb>& value) {
    if (value && *value != Rgb(1))
      mix.factors_.push_back({group, *value});
    return value && (*value == Rgb(1) || !group.empty());
  };
  for (std::size_t i = 0; i < rendered.lights.size(); ++i)
    if (!add(rendered.lights[i].group,
             factor(strength(rendered.lights[i]), strength(edited.lights[i]))))
      return std::nullopt;
  for (std::size_t i = 0; i < rendered.surfaces.size(); ++i)
    if (shines(rendered.surfaces[i].material) || shines(edited.surfaces[i].material))
      if (!add(rendered.surfaces[i].group, factor(strength(rendered.surfaces[i].material),
                                                  strength(edited.surfaces[i].material))))
        return std::nullopt;
  return mix;
}

std::optional<Image> LightMix::apply(const Image& image) const {
  Image result{.width = image.width,
               .height = image.height,
               .x = image.x,
               .y = image.y,
               .full_width = image.full_width,
               .full_height = image.full_height,
               .primaries = image.primaries,
               .channels = {},
               .metadata = image.metadata,
               .numbers = image.numbers,
               .integers = image.integers,
               .matrices = image.matrices};
  for (const ImageChannel& channel : image.channels)
    if (channel.name.size() == 1) // R, G, B and A: the groups need not be copied
      result.channels.push_back(channel);
  for (ImageChannel& channel : result.channels) {
    const std::size_t c = std::string("RGB").find(channel.name);
    for (const Factor& factor : factors_) {
      if (c == std::string::npos || factor.value[static_cast<int>(c)] == 1)
        continue;
      const ImageChannel* own = image.find(fmt::format("light_{}.{}", factor.group, channel.name));
      if (!own)
        return std::nullopt;
      for (std::size_t i = 0; i < channel.data.size(); ++i)
        channel.data[i] += own->data[i] * (factor.value[static_cast<int>(c)] - 1);
    }
  }
  return result;
}

} // namespace vdbeam
