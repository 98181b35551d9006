#include "transport/build_surfaces.h"

#include "geometry/placed.h"
#include "materials/material_table.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace vdbeam {
namespace {

Affine moved(const Vec3d& by) {
  Affine map;
  map.translation = by;
  return map;
}

/// From the axes of a file to those of the scene.
Affine turned(FileAxes axes) {
  Affine map;
  if (axes == FileAxes::y_up_to_z_up)
    map.rows = {Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}};
  if (axes == FileAxes::z_up_to_y_up)
    map.rows = {Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}};
  return map;
}

/// Throws InputError where single precision, in which Embree works, cannot hold both a surface and
/// the rest of the scene; the medium is about 1 wide.
void check_sizes(const std::vector<PlacedShape>& surfaces) {
  constexpr double widest = 4e9, farthest = 1e17;
  double reach = 1e5;
  const auto check = [](bool sound, std::size_t i, const char* wrong) {
    if (!sound)
      throw InputError(fmt::format("mesh.{}: is {} the rest of the scene: leave it out, or check "
                                   "its scale and place",
                                   i, wrong));
  };
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].shape->is_infinite()) {
      check(length(surfaces[i].to_render.translation) < farthest, i, "too far away from");
      continue;
    }
    const Boxd box = mapped(surfaces[i].to_render, surfaces[i].shape->bounds());
    const double size = max_component(box.size()), away = length(box.center()) + size;
    check(size < widest, i, "thousands of millions of times larger than");
    check(away < farthest, i, "too far away from");
    reach = std::max(reach, away);
  }
  // In a surface's own space coordinates are larger by the factor by which it is smaller.
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    check(least_stretch(surfaces[i].to_render.inverse()) > reach / farthest, i,
          "a million million times smaller, in some direction, than");
}

const char* key_of(TextureUse use) {
  constexpr const char* keys[] = {"texture", "opacity_texture", "roughness_texture",
                                  "metal_texture", "normal_texture"};
  return keys[static_cast<std::size_t>(use)];
}

/// Adds the materials and textures of a surface. The result has its holes and normals, but neither
/// shape nor place.
PlacedShape add_material(const SurfaceSettings& settings, double scale, SurfaceStore& store,
                         Surfaces& surfaces, std::vector<std::string>& notes) {
  const MaterialSettings& material = settings.material;
  const auto texture = [&](TextureUse use, bool shines = false) {
    return store.texture(material, use, shines, notes);
  };
  surfaces.materials.push_back(make_material(material, scale));
  surfaces.textures.push_back(texture(TextureUse::color, surfaces.materials.back()->shines()));
  const auto roughness = texture(TextureUse::roughness), metal = texture(TextureUse::metal),
             opacity = texture(TextureUse::opacity), normals = texture(TextureUse::normal);
  surfaces.maps.push_back(
      roughness || metal ? std::make_shared<const MaterialMaps>(material, scale, roughness, metal)
                         : nullptr);
  surfaces.lights.push_back(-1);
  PlacedShape placed;
  placed.visible = settings.visible;
  placed.textured = has_texture(material);
  if (material.opacity < 1 || opacity || normals)
    placed.detail = std::make_shared<const SurfaceDetail>(material, opacity, normals);
  return placed;
}

const Boxd everywhere{Vec3d(-1e300), Vec3d(1e300)};

/// The material of a lamp whose power is given [W]: radiance times pi times the area of its sides.
std::unique_ptr<Material> material_of_power(MaterialSettings material, double world_area,
                                            double scale) {
  const double sides = material.two_sided ? 2 : 1;
  material.radiance = Rgb(Vec3d(*material.power) / (std::numbers::pi * world_area * sides));
  material.power.reset();
  return make_material(material, scale);
}

} // namespace

std::vector<WorldShape> read_shapes(const std::vector<SurfaceSettings>& settings,
                                    SurfaceStore& store, std::vector<std::string>& notes) {
  std::vector<WorldShape> shapes;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const SurfaceStore::KnownShape& known = store.shape(settings[i], notes);
    for (const TextureUse use : texture_uses)
      if (!texture_file(settings[i].material, use).file.empty() && !known.shape->has_uvs())
        throw InputError(fmt::format("{}: has no texture coordinates (UV), which "
                                     "mesh.{}.material.{} needs: export it with them, or leave out "
                                     "the texture",
                                     settings[i].file, i, key_of(use)));
    shapes.push_back({known.shape, Affine::from_matrix(settings[i].transform)
                                       .after(turned(settings[i].file_axes))
                                       .after(moved(known.center))});
  }
  return shapes;
}

Boxd world_bounds(const std::vector<WorldShape>& shapes) {
  Boxd bounds;
  for (const WorldShape& entry : shapes) {
    if (entry.shape->is_infinite())
      continue;
    const Boxd box = entry.shape->bounds();
    for (int corner = 0; corner < 8; ++corner)
      bounds.extend(entry.to_world.point({corner & 1 ? box.upper.x : box.lower.x,
                                          corner & 2 ? box.upper.y : box.lower.y,
                                          corner & 4 ? box.upper.z : box.lower.z}));
  }
  return bounds;
}

std::shared_ptr<const Surfaces>
build_surfaces(const std::vector<SurfaceSettings>& settings, const std::vector<WorldShape>& shapes,
               const RenderSpace& space, const OccupiedRegion& medium,
               const std::shared_ptr<SurfaceStore>& store, const SurfaceSet* previous,
               std::vector<std::string>& notes) {
  if (settings.empty())
    return nullptr;
  auto surfaces = std::make_shared<Surfaces>();
  surfaces->store = store;
  std::vector<PlacedShape> placed;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    placed.push_back(add_material(settings[i], space.scale, *store, *surfaces, notes));
    placed[i].shape = shapes[i].shape;
    placed[i].to_render = space.map().after(shapes[i].to_world);
  }
  check_sizes(placed);
  const double reach = static_cast<double>(length(medium.center) + medium.radius);
  surfaces->set = std::make_shared<const SurfaceSet>(std::move(placed), reach, previous);
  for (std::size_t i = 0; i < settings.size(); ++i)
    if (settings[i].material.power)
      surfaces->materials[i] = material_of_power(
          settings[i].material, surfaces->set->area(i) / (space.scale * space.scale), space.scale);
  for (std::size_t i = 0; i < settings.size(); ++i)
    if (surfaces->materials[i]->is_solid())
      surfaces->solids.push_back(shapes[i].shape->is_infinite() ? everywhere
                                                                : surfaces->set->bounds(i));
  return surfaces;
}

} // namespace vdbeam
