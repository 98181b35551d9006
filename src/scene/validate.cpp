#include "scene/validate.h"

#include "film/layers.h"
#include "image/color_conversion.h"
#include "keys/estimator_kind.h"
#include "keys/scene_keys.h"
#include "layers/plane_layers.h"
#include "lights/light_groups.h"
#include "lights/light_table.h"
#include "lights/sky/aerial_perspective.h"
#include "materials/material_table.h"
#include "phase/phase_table.h"
#include "text/attributes.h"
#include "text/curve.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"
#include "volume/fog_shape.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

class Checker {
public:
  Checker(const Scene& scene, const KeyLocator& locate) : scene_(scene), locate_(locate) {}

  void check_camera() const {
    const CameraSettings& camera = scene_.camera;
    const Vec3d view = camera.look_at - camera.position;
    if (length(view) == 0)
      fail("camera.look_at", "must differ from camera.position");
    if (length(camera.up) == 0)
      fail("camera.up", "must not be [0, 0, 0]");
    // A sine under 1e-6 leaves no digits for the camera's sideways axis.
    if (const Vec3d up = camera.picture_up.value_or(camera.up);
        length(cross(normalize(view), normalize(up))) < 1e-6)
      fail("camera.up", "must not be parallel to the direction from position to look_at");
    check_lens();
  }

  void check_lens() const {
    const CameraSettings& camera = scene_.camera;
    const bool perspective = camera.projection == Projection::perspective;
    if (camera.projection == Projection::orthographic && !(camera.view_height > 0))
      fail("camera.projection", "is \"orthographic\": camera.view_height is needed too");
    if (camera.far && *camera.far <= camera.near)
      fail("camera.far",
           fmt::format("must be greater than camera.near ({}), got {}", camera.near, *camera.far));
    if (camera.f_stop && !camera.focal_length)
      fail("camera.f_stop", "needs camera.focal_length, or write camera.lens_radius");
    if (camera.f_stop && camera.lens_radius > 0)
      fail("camera.f_stop", "excludes camera.lens_radius: write one or the other");
    if (camera.aperture_radius() > 0 && !perspective)
      fail(camera.f_stop ? "camera.f_stop" : "camera.lens_radius",
           "needs camera.projection = \"perspective\"");
    if (camera.shutter_close < camera.shutter_open)
      fail("camera.shutter_close", fmt::format("must be at least camera.shutter_open ({}), got {}",
                                               camera.shutter_open, camera.shutter_close));
    for (const Scene& moment : scene_.moments)
      if (moment.volumes.size() != scene_.volumes.size() ||
          moment.lights.size() != scene_.lights.size())
        fail("camera.shutter_open",
             "needs moments with the same number of volumes and lights as the scene");
    if (camera.blades == 1 || camera.blades == 2)
      fail("camera.blades", fmt::format("must be 0 or at least 3, got {}", camera.blades));
  }

  void check_volume(std::size_t index) const {
    check_transform(fmt::format("volume.{}.transform", index), scene_.volumes[index].transform);
    const VolumeSettings& volume = scene_.volumes[index];
    if (volume.fog.made())
      check_fog(index);
    if (const std::string why = why_no_curve(volume.remap.curve, 1); !why.empty())
      fail(fmt::format("volume.{}.density_curve", index), why);
    if (const std::string why = why_no_curve(volume.emission.ramp, 3); !why.empty())
      fail(fmt::format("volume.{}.emission.ramp", index), why);
    if (volume.box_lower.has_value() != volume.box_upper.has_value())
      fail(fmt::format("volume.{}.{}", index, volume.box_lower ? "box_lower" : "box_upper"),
           "needs the other corner too: box_lower and box_upper");
    for (int a = 0; a < 3 && volume.box_lower; ++a)
      if (!((*volume.box_lower)[a] < (*volume.box_upper)[a]))
        fail(fmt::format("volume.{}.box_upper", index),
             "must be greater than box_lower along all three axes");
    if (const auto complaint = phase_kind(volume.phase.type).complaint(volume.phase))
      fail(fmt::format("volume.{}.phase.{}", index, complaint->key), complaint->text);
  }

  void check_fog(std::size_t index) const {
    const VolumeSettings& volume = scene_.volumes[index];
    for (const auto& [key, grid] : {std::pair("intensity", volume.emission.intensity),
                                    std::pair("temperature", volume.emission.temperature)})
      if (!grid.empty() && grid != "density")
        fail(fmt::format("volume.{}.emission.{}", index, key),
             fmt::format("must be \"density\" for a shape, which has no other grid, got \"{}\"",
                         grid));
    if (volume.noise.amplitude > 0)
      check_noise(index);
  }

  /// Noise must not be finer than a shape's lattice can be.
  void check_noise(std::size_t index) const {
    const VolumeSettings& volume = scene_.volumes[index];
    const double widest = max_component(box_of(volume).size());
    constexpr double most_features = 1000;
    if (volume.noise.size * most_features < widest)
      fail(fmt::format("volume.{}.noise_size", index),
           fmt::format("must be at least a thousandth of the box, {:g}, got {:g}",
                       widest / most_features, volume.noise.size));
    if (volume.noise.amplitude > widest)
      fail(fmt::format("volume.{}.noise_amplitude", index),
           fmt::format("must be at most the size of the box, {:g}, got {:g}", widest,
                       volume.noise.amplitude));
  }

  void check_transform(const std::string& path, const std::array<double, 12>& m) const {
    const Vec3d a{m[0], m[1], m[2]}, b{m[4], m[5], m[6]}, c{m[8], m[9], m[10]};
    const double size = length(a) * length(b) * length(c);
    if (!(std::abs(dot(a, cross(b, c))) > 1e-12 * size))
      fail(path, "must be invertible (no scale may be 0)");
  }

  void check_emission(std::size_t index) const {
    const EmissionSettings& emission = scene_.volumes[index].emission;
    if (!emission.intensity.empty() || !emission.temperature.empty())
      return;
    for (const SceneKey& key : scene_keys())
      if (key.section == SceneSection::emission &&
          key.format(key.get(scene_, index)) != key.default_text())
        fail(fmt::format("volume.{}.emission", index),
             "must name the grid that glows: intensity, temperature or both");
  }

  void check_light(std::size_t index) const {
    const LightSettings& light = scene_.lights[index];
    if (const auto complaint = light_kind(light.type).complaint(light))
      fail(fmt::format("light.{}.{}", index, complaint->key), complaint->text);
    const int with_air = light_with_air(scene_.lights);
    if (light.type == LightType::atmosphere && light.metres_per_unit &&
        with_air < static_cast<int>(index))
      fail(fmt::format("light.{}.metres_per_unit", index),
           fmt::format("must be there once: light.{} has the air between camera and scene",
                       with_air));
  }

  void check_mesh(std::size_t index) const {
    const SurfaceSettings& surface = scene_.surfaces[index];
    if (surface.shape == SurfaceShape::file && surface.file.empty())
      fail(fmt::format("mesh.{}", index),
           "needs a file, or a type that needs none: sphere, quad, disk, plane, box or cylinder");
    if (surface.shape == SurfaceShape::plane && shines(surface.material))
      fail(fmt::format("mesh.{}.material.type", index),
           "must not emit on a plane, which has no end: use type = \"quad\" with a scale, or a "
           "light "
           "of type \"environment\"");
    check_transform(fmt::format("mesh.{}.transform", index), surface.transform);
  }

  void check_group(const std::string& path, const std::string& group) const {
    const bool plain = std::all_of(group.begin(), group.end(),
                                   [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    if (!plain || group == rest_group)
      fail(path,
           fmt::format("must be made of letters, digits and _, and not be \"rest\", got \"{}\"",
                       group));
  }

  void check_groups() const {
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
      check_group(fmt::format("light.{}.group", i), scene_.lights[i].group);
    for (std::size_t i = 0; i < scene_.surfaces.size(); ++i) {
      const SurfaceSettings& surface = scene_.surfaces[i];
      check_group(fmt::format("mesh.{}.group", i), surface.group);
      if (!surface.group.empty() && !shines(surface.material))
        fail(fmt::format("mesh.{}.group", i),
             "is for a mesh that shines: give it an emissive material, or leave the group out");
    }
    if (!light_group_names(scene_).empty() && scene_.render.clamp)
      fail("render.clamp", "excludes groups of lights (light.group, mesh.group)");
  }

  void check_layers() const {
    std::vector<std::string> others = volume_layer_names(scene_);
    for (const std::string& group : light_group_names(scene_))
      others.push_back("light_" + group);
    for (std::size_t i = 0; i < scene_.layers.size(); ++i) {
      const std::string path = fmt::format("layer.{}.name", i);
      const std::string& name = scene_.layers[i].name;
      if (const std::string why = why_no_layer(name, others); !why.empty())
        fail(path, why);
      for (std::size_t j = 0; j < i; ++j)
        if (scene_.layers[j].name == name)
          fail(path, fmt::format("must not be there twice, got \"{}\"", name));
    }
    check_volume_layers();
  }

  /// How the picture is written.
  void check_file() const {
    const ImageSettings& image = scene_.image;
    for (std::size_t i = 0; i < scene_.layers.size(); ++i)
      if (scene_.layers[i].compression && image.parts == ImageParts::one)
        fail(fmt::format("layer.{}.compression", i), "needs image.parts = \"layers\"");
    if (const std::string why = why_no_attributes(image.attributes); !why.empty())
      fail("image.attributes", why);
    if (image.time_code.empty())
      return;
    if (!image.fps || *image.fps > 30)
      fail("image.time_code", "needs image.fps, of at most 30");
    if (!frames_of_time_code(image.time_code, static_cast<int>(std::ceil(*image.fps - 1e-6))))
      fail("image.time_code", fmt::format("must be \"hh:mm:ss:ff\", got \"{}\"", image.time_code));
  }

  void check_volume_layers() const {
    bool any = asks_for_layer(scene_, "volumes");
    for (const std::string& name : volume_layer_names(scene_))
      any = any || asks_for_layer(scene_, name);
    if (any && scene_.render.clamp)
      fail("render.clamp", "excludes layers of volumes");
    for (std::size_t i = 0; i < scene_.volumes.size() && any; ++i)
      if (const std::string why = why_no_volume_layer(scene_.volumes[i].name); !why.empty())
        fail(fmt::format("volume.{}.name", i), why);
  }

  void check_render() const {
    const RenderSettings& render = scene_.render;
    if (!scene_.surfaces.empty() &&
        !estimator_kind(render.estimator).stages.contains(Stage::surfaces))
      fail("render.estimator", fmt::format("is \"{}\", which cannot render a [[mesh]] yet: write "
                                           "estimator = \"path\"",
                                           render.estimator.name));
    if (const std::string why = why_no_output_space(scene_.image.output_space); !why.empty())
      fail("image.output_space", why);
    if (scene_.image.deep && render.clamp)
      fail("image.deep", "excludes render.clamp");
    if (render.kernel == KernelRadius::fixed && render.radius == 0)
      fail("render.kernel", "is \"fixed\": render.radius is needed too");
    if (render.min_radius > 0 && render.max_radius > 0 && render.min_radius > render.max_radius)
      fail("render.min_radius", fmt::format("must be at most render.max_radius ({}), got {}",
                                            render.max_radius, render.min_radius));
  }

private:
  [[noreturn]] void fail(const std::string& path, const std::string& text) const {
    throw InputError(fmt::format("{}: {} {}", locate_(path), path, text));
  }

  const Scene& scene_;
  const KeyLocator& locate_;
};

} // namespace

void validate_consistency(const Scene& scene, const KeyLocator& locate) {
  const Checker checker(scene, locate);
  checker.check_camera();
  for (std::size_t i = 0; i < scene.volumes.size(); ++i)
    checker.check_volume(i);
  for (std::size_t i = 0; i < scene.volumes.size(); ++i)
    checker.check_emission(i);
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
    checker.check_mesh(i);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    checker.check_light(i);
  checker.check_groups();
  checker.check_layers();
  checker.check_file();
  checker.check_render();
}

void validate_scene(const Scene& scene) {
  std::string name = scene.path.empty() ? "scene" : scene.path;
  for (const SceneKey& key : scene_keys()) {
    if (!key.get)
      continue;
    for (std::size_t i = 0; i < section_count(scene, key.section); ++i)
      if (const auto complaint = key.complaint(key.get(scene, i));
          complaint && (!key.required || takes_key(scene, i, key)))
        throw InputError(fmt::format("{}: {} {}", name, key_path(key, i), *complaint));
  }
  validate_consistency(scene, [&](const std::string&) -> std::string { return name; });
}

} // namespace vdbeam
