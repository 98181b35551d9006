#include "transport/surface_store.h"

#include "geometry/corner_normals.h"
#include "geometry/gltf/gltf_files.h"
#include "geometry/gltf/gltf_images.h"
#include "geometry/mesh_reader.h"
#include "machine/stop_reading.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

/// The entry of a name, or null.
template <class Map>
const typename Map::mapped_type* find(const Map& map, const std::string& name) {
  const auto found = map.find(name);
  return found == map.end() ? nullptr : &found->second;
}

} // namespace

SurfaceStore::SurfaceStore(const std::vector<SurfaceSettings>& settings,
                           const SurfaceStore* previous)
    : previous_(previous) {
  for (const SurfaceSettings& surface : settings)
    textured_[surface.file] = textured_[surface.file] || has_texture(surface.material);
}

const SurfaceStore::KnownShape& SurfaceStore::shape(const SurfaceSettings& surface,
                                                    std::vector<std::string>& notes) {
  const bool from_file = surface.shape == SurfaceShape::file, uvs = textured_[surface.file];
  const std::string name =
      from_file ? fmt::format("{}|{}|{}|{}|{}|{}", model_identity(surface.file), uvs ? "uv" : "",
                              surface.file_normals ? "normals" : "", surface.smooth_angle,
                              surface.part, surface.file_seconds.value_or(-1))
                : fmt::format("{}", static_cast<int>(surface.shape));
  if (const KnownShape* known = find(shapes_, name))
    return *known;
  KnownShape made;
  if (const KnownShape* known = previous_ ? find(previous_->shapes_, name) : nullptr) {
    made = *known;
  } else if (from_file) {
    Mesh mesh = read_mesh(surface.file, {.uvs = uvs,
                                         .normals = surface.file_normals,
                                         .material = surface.part,
                                         .seconds = surface.file_seconds});
    ++meshes_read_;
    made.center = mesh.center;
    made.notes = std::move(mesh.notes);
    StopReading::check();
    complete_normals(mesh, surface.smooth_angle);
    StopReading::check();
    made.shape = make_mesh_shape(std::move(mesh));
  } else {
    made.shape = make_simple_shape(surface.shape);
  }
  notes.insert(notes.end(), made.notes.begin(), made.notes.end());
  return shapes_[name] = std::move(made);
}

std::shared_ptr<const Texture> SurfaceStore::texture(const MaterialSettings& material,
                                                     TextureUse use, bool shines,
                                                     std::vector<std::string>& notes) {
  const auto [file, image] = texture_file(material, use);
  if (file.empty())
    return nullptr;
  // The colours of an image are not its opacity, even where it has no alpha channel.
  const bool colors = use == TextureUse::opacity &&
                      texture_file(material, use) == texture_file(material, TextureUse::color);
  const std::string name =
      fmt::format("{}|{}|{}|{}|{}|{}|{}", model_identity(file), image, static_cast<int>(use),
                  static_cast<int>(material.texture_wrap), static_cast<int>(material.color_space),
                  shines, colors);
  if (const KnownTexture* known = find(textures_, name))
    return known->texture;
  KnownTexture made;
  if (const KnownTexture* known = previous_ ? find(previous_->textures_, name) : nullptr) {
    made = *known;
  } else {
    const GltfPicture picture{file, image, ""};
    Image pixels = read_picture(picture);
    made.texture = std::make_shared<const Texture>(
        use == TextureUse::color
            ? make_texture(std::move(pixels), file, material, shines, made.notes)
            : make_data_texture(std::move(pixels), file,
                                {use, material.texture_wrap, is_encoded(picture), colors},
                                made.notes));
    ++textures_read_;
  }
  notes.insert(notes.end(), made.notes.begin(), made.notes.end());
  textures_[name] = made;
  return made.texture;
}

} // namespace vdbeam
