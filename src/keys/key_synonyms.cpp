#include "keys/key_synonyms.h"

#include "text/text.h"

#include <array>
#include <fmt/format.h>
#include <sstream>

namespace vdbeam {
namespace {

using S = SceneSection;

constexpr std::string_view strength =
    "colour and strength of a light are one key: irradiance of a distant light, intensity or power "
    "of a point or spot light, radiance of an environment or sky, e.g. irradiance = [5, 4, 3]; "
    "kelvin "
    "and exposure multiply it";
constexpr std::string_view strength_keys = "irradiance intensity radiance";
constexpr std::string_view aim =
    "direction = [x, y, z] is the way that a distant or spot light travels";
constexpr std::string_view area_light =
    "a light with an area is a [[mesh]] with material = { type = \"emissive\", radiance = 10 }";
constexpr std::string_view solid = "solids come from files (.obj, .ply, .gltf, .glb)";

constexpr std::array synonyms{
    KeySynonym{S::light, "color", strength_keys, strength},
    KeySynonym{S::light, "colour", strength_keys, strength},
    KeySynonym{S::light, "temperature", "kelvin", ""},
    KeySynonym{S::light, "color_temperature", "kelvin", ""},
    KeySynonym{S::light, "stops", "exposure", ""},
    KeySynonym{S::light, "watts", "power", ""},
    KeySynonym{S::light, "ies_file", "ies", ""},
    KeySynonym{S::light, "profile", "ies", ""},
    KeySynonym{S::light, "photometry", "ies", ""},
    KeySynonym{S::light, "turbidity", "aerosol", ""},
    KeySynonym{S::light, "haze", "aerosol", ""},
    KeySynonym{S::light, "gobo", "image", ""},
    KeySynonym{S::light, "penumbra", "cone_falloff", ""},
    KeySynonym{S::light, "softness", "cone_falloff", ""},
    KeySynonym{S::light, "strength", strength_keys, strength},
    KeySynonym{S::light, "energy", strength_keys, strength},
    KeySynonym{S::light, "multiplier", strength_keys, strength},
    KeySynonym{S::light, "brightness", strength_keys, strength},
    KeySynonym{S::light, "elevation", "direction", aim},
    KeySynonym{S::light, "azimuth", "direction", aim},
    KeySynonym{S::light, "rotate", "direction rotation",
               "direction = [x, y, z] is the direction in which a distant or spot light travels; "
               "rotation turns an environment"},
    KeySynonym{S::light, "target", "direction", aim},
    KeySynonym{S::light, "angle", "angular_radius cone_angle", ""},
    KeySynonym{S::light, "size", "angular_radius", ""},
    KeySynonym{S::light, "radius", "angular_radius", area_light},
    KeySynonym{S::light, "translate", "position", ""},
    KeySynonym{S::light, "file", "image ies", ""},
    KeySynonym{S::light, "texture", "image", ""},
    KeySynonym{S::light, "map", "image", ""},

    KeySynonym{S::render, "keep", "", "render.photons says how many photons a pass stores"},
    KeySynonym{S::render, "samples", "passes", ""},
    KeySynonym{S::render, "spp", "passes", ""},
    KeySynonym{S::render, "camera_samples", "passes", ""},
    KeySynonym{S::render, "iterations", "passes", ""},
    KeySynonym{S::render, "integrator", "estimator", ""},
    KeySynonym{S::render, "max_depth", "max_bounces", ""},
    KeySynonym{S::render, "bounces", "max_bounces", ""},
    KeySynonym{S::render, "volume_bounces", "max_bounces", ""},
    KeySynonym{S::render, "time_limit", "time", ""},
    KeySynonym{S::render, "noise_threshold", "target_error", ""},
    KeySynonym{S::render, "threshold", "target_error", ""},
    KeySynonym{S::render, "width", "image.width", ""},
    KeySynonym{S::render, "height", "image.height", ""},
    KeySynonym{S::render, "resolution", "image.width image.height", ""},

    KeySynonym{S::image, "resolution", "width height", ""},
    KeySynonym{S::image, "size", "width height", ""},
    KeySynonym{S::image, "samples", "render.passes", ""},
    KeySynonym{S::image, "spp", "render.passes", ""},
    KeySynonym{S::image, "color_space", "working_space output_space", ""},
    KeySynonym{S::image, "exposure", "",
               "radiance is written as it is; --exposure brightens a "
               "--preview"},
    KeySynonym{S::image, "file", "", "the image is named on the command line: -o FILE"},
    KeySynonym{S::image, "output", "", "the image is named on the command line: -o FILE"},

    KeySynonym{S::camera, "target", "look_at", ""},
    KeySynonym{S::camera, "lookat", "look_at", ""},
    KeySynonym{S::camera, "interest", "look_at", ""},
    KeySynonym{S::camera, "eye", "position", ""},
    KeySynonym{S::camera, "origin", "position", ""},
    KeySynonym{S::camera, "translate", "position", ""},
    KeySynonym{S::camera, "location", "position", ""},
    KeySynonym{S::camera, "rotate", "look_at", ""},
    KeySynonym{S::camera, "rotation", "look_at", ""},
    KeySynonym{S::camera, "angle", "fov", ""},
    KeySynonym{S::camera, "lens", "focal_length", ""},
    KeySynonym{S::camera, "sensor_width", "film_width", ""},
    KeySynonym{S::camera, "horizontal_aperture", "film_width", ""},
    KeySynonym{S::camera, "aperture", "f_stop lens_radius", ""},
    KeySynonym{S::camera, "focus", "focus_distance", ""},
    KeySynonym{S::camera, "clip_start", "near", ""},
    KeySynonym{S::camera, "clip_end", "far", ""},
    KeySynonym{S::camera, "shutter", "shutter_open shutter_close", ""},
    KeySynonym{S::camera, "motion_blur", "shutter_open shutter_close", ""},
    KeySynonym{S::camera, "resolution", "image.width image.height", ""},

    KeySynonym{S::phase, "anisotropy", "g", ""},
    KeySynonym{S::phase, "asymmetry", "g", ""},
    KeySynonym{S::phase, "diameter", "droplet_diameter", ""},
    KeySynonym{S::phase, "name", "type", ""},

    KeySynonym{S::volume, "anisotropy", "phase.g",
               "write phase = { type = \"henyey_greenstein\", g = 0.6 }"},
    KeySynonym{S::volume, "g", "phase.g",
               "write phase = { type = \"henyey_greenstein\", g = 0.6 }"},
    KeySynonym{S::volume, "color", "albedo", ""},
    KeySynonym{S::volume, "colour", "albedo", ""},
    KeySynonym{S::volume, "scattering", "albedo extinction", ""},
    KeySynonym{S::volume, "absorption", "albedo extinction", ""},
    KeySynonym{S::volume, "sigma_t", "extinction", ""},
    KeySynonym{S::volume, "density_multiplier", "extinction", ""},
    KeySynonym{S::volume, "grid", "density", ""},
    KeySynonym{S::volume, "path", "file", ""},
    KeySynonym{S::volume, "type", "shape", ""},
    KeySynonym{S::volume, "falloff", "scale_height", ""},
    KeySynonym{S::volume, "filename", "file", ""},
    KeySynonym{S::volume, "position", "translate", ""},
    KeySynonym{S::volume, "location", "translate", ""},
    KeySynonym{S::volume, "rotation", "rotate", ""},
    KeySynonym{S::volume, "temperature", "emission.temperature", ""},
    KeySynonym{S::volume, "step_size", "render.step", ""},

    KeySynonym{S::emission, "strength", "scale", ""},
    KeySynonym{S::emission, "grid", "intensity", ""},

    KeySynonym{S::mesh, "path", "file", ""},
    KeySynonym{S::mesh, "filename", "file", ""},
    KeySynonym{S::mesh, "position", "translate", ""},
    KeySynonym{S::mesh, "location", "translate", ""},
    KeySynonym{S::mesh, "rotation", "rotate", ""},
    KeySynonym{S::mesh, "radius", "scale", ""},
    KeySynonym{S::mesh, "size", "scale", ""},
    KeySynonym{S::mesh, "color", "material.albedo", ""},
    KeySynonym{S::mesh, "colour", "material.albedo", ""},
    KeySynonym{S::mesh, "albedo", "material.albedo", ""},

    KeySynonym{S::material, "color", "albedo", ""},
    KeySynonym{S::material, "colour", "albedo", ""},
    KeySynonym{S::material, "base_color", "albedo", ""},
    KeySynonym{S::material, "metallic", "metal", ""},
    KeySynonym{S::material, "metalness", "metal", ""},
    KeySynonym{S::material, "clearcoat", "coat", ""},
    KeySynonym{S::material, "coat_weight", "coat", ""},
    KeySynonym{S::material, "clearcoat_roughness", "coat_roughness", ""},
    KeySynonym{S::material, "emission", "radiance", ""},
    KeySynonym{S::material, "intensity", "radiance power", ""},
    KeySynonym{S::material, "temperature", "kelvin", ""},
    KeySynonym{S::material, "image", "texture", ""},
    KeySynonym{S::material, "index", "ior", ""},

    KeySynonym{S::instance, "name", "volume", ""},
    KeySynonym{S::instance, "points", "file", ""},
    KeySynonym{S::instance, "path", "file", ""},
    KeySynonym{S::instance, "transform", "columns", ""},
    KeySynonym{S::instance, "translate", "columns", ""},

    KeySynonym{S::layer, "type", "name", ""},
    KeySynonym{S::layer, "aov", "name", ""},
};

constexpr std::array values{
    ValueSynonym{S::light, "type", "physical_sky", "atmosphere", ""},
    ValueSynonym{S::light, "type", "nishita", "atmosphere", ""},
    ValueSynonym{S::light, "type", "hosek_wilkie", "atmosphere", ""},
    ValueSynonym{S::light, "type", "sun_sky", "atmosphere", ""},
    ValueSynonym{S::light, "type", "directional", "distant", ""},
    ValueSynonym{S::light, "type", "infinite", "distant", ""},
    ValueSynonym{S::light, "type", "dome", "environment", ""},
    ValueSynonym{S::light, "type", "skydome", "environment", ""},
    ValueSynonym{S::light, "type", "hdri", "environment", ""},
    ValueSynonym{S::light, "type", "omni", "point", ""},
    ValueSynonym{S::light, "type", "area", "", area_light},
    ValueSynonym{S::light, "type", "rect", "", area_light},
    ValueSynonym{S::light, "type", "quad", "", area_light},
    ValueSynonym{S::light, "type", "disk", "", area_light},
    ValueSynonym{S::light, "type", "sphere", "", area_light},
    ValueSynonym{S::light, "type", "mesh", "", area_light},
    ValueSynonym{S::volume, "shape", "ball", "sphere", ""},
    ValueSynonym{S::volume, "shape", "cube", "box", ""},
    ValueSynonym{S::volume, "shape", "homogeneous", "box", ""},
    ValueSynonym{S::volume, "shape", "exponential", "height", ""},
    ValueSynonym{S::phase, "type", "hg", "henyey_greenstein", ""},
    ValueSynonym{S::phase, "type", "double_hg", "two_lobe", ""},
    ValueSynonym{S::emission, "law", "blackbody", "planck", ""},
    ValueSynonym{S::render, "kernel_shape", "epan", "epanechnikov", ""},
    ValueSynonym{S::mesh, "type", "grid", "quad", ""},
    ValueSynonym{S::mesh, "type", "rect", "quad", ""},
    ValueSynonym{S::mesh, "type", "square", "quad", ""},
    ValueSynonym{S::mesh, "type", "ball", "sphere", ""},
    ValueSynonym{S::mesh, "type", "circle", "disk", ""},
    ValueSynonym{S::mesh, "type", "mesh", "file", ""},
    ValueSynonym{S::mesh, "type", "cube", "box", ""},
    ValueSynonym{S::mesh, "type", "tube", "cylinder", ""},
    ValueSynonym{S::mesh, "type", "ground", "plane", ""},
    ValueSynonym{S::mesh, "type", "ground_plane", "plane", ""},
    ValueSynonym{S::mesh, "type", "cone", "", solid},
    ValueSynonym{S::mesh, "type", "torus", "", solid},
    ValueSynonym{S::material, "type", "metal", "conductor", ""},
    ValueSynonym{S::material, "type", "glass", "dielectric", ""},
    ValueSynonym{S::material, "type", "lambert", "diffuse", ""},
    ValueSynonym{S::material, "type", "matte", "diffuse", ""},
    ValueSynonym{S::material, "type", "emission", "emissive", ""},
    ValueSynonym{S::material, "type", "light", "emissive", ""},
};

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
    words.push_back(word);
  return words;
}

const KeySynonym* find_synonym(SceneSection section, const std::string& word) {
  for (const KeySynonym& synonym : synonyms)
    if (synonym.section == section && synonym.word == lower_case(word))
      return &synonym;
  return nullptr;
}

} // namespace

std::span<const KeySynonym> key_synonyms() {
  return synonyms;
}

std::span<const ValueSynonym> value_synonyms() {
  return values;
}

std::string synonym_remedy(SceneSection section, const std::string& word) {
  const KeySynonym* const found = find_synonym(section, word);
  if (!found)
    return {};
  if (!found->remedy.empty())
    return fmt::format("; {}", found->remedy);
  return fmt::format("; did you mean {}?", join_words(words_of(found->keys), "and"));
}

std::string key_meant_by(const std::string& word) {
  for (const SceneSection section : {S::image, S::render, S::camera}) {
    if (const KeySynonym* found = find_synonym(section, word); found && !found->keys.empty()) {
      const std::string key = words_of(found->keys).front();
      return key.find('.') == std::string::npos ? section_name(section) + "." + key : key;
    }
  }
  return {};
}

std::string value_remedy(SceneSection section, const std::string& key, const std::string& word) {
  for (const ValueSynonym& synonym : values)
    if (synonym.section == section && synonym.key == key && synonym.word == lower_case(word))
      return synonym.value.empty() ? fmt::format("; {}", synonym.remedy)
                                   : fmt::format("; did you mean {}?", synonym.value);
  return {};
}

} // namespace vdbeam
