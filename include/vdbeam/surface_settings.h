#pragma once

#include "vdbeam/camera_settings.h"
#include "vdbeam/color_space.h"
#include "vdbeam/kinds.h"
#include "vdbeam/vec.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace vdbeam {

/// Texture lookup beyond the edges of the image.
enum class TextureWrap { repeat, mirror, clamp };

/// What the textures of a material are for: factors of its albedo or radiance, of its opacity,
/// roughness and metal, and the direction of its normal.
enum class TextureUse { color, opacity, roughness, metal, normal };
inline constexpr std::array texture_uses{TextureUse::color, TextureUse::opacity,
                                         TextureUse::roughness, TextureUse::metal,
                                         TextureUse::normal};

struct MaterialSettings {
  MaterialType type = MaterialType::diffuse;
  /// diffuse, standard, shadow_catcher: share of the light that is reflected, per channel; none:
  /// 0.8, or 1 where there is a texture.
  std::optional<Rgb> albedo;
  /// diffuse, standard, shadow_catcher, emissive: image that multiplies albedo or radiance; "":
  /// none
  std::string texture;
  /// diffuse, standard, conductor, holdout: share of the rays that the surface stops, each by a
  /// draw of its own; the others go straight on.
  double opacity = 1;
  std::string opacity_texture; ///< image that multiplies it, by its alpha channel or its green one
  /// Points whose opacity is less are holes, and others stop all rays; 0: each stops its share.
  double opacity_cutoff = 0;
  std::string roughness_texture; ///< conductor, standard: image whose green multiplies roughness
  std::string metal_texture;     ///< standard: image whose blue multiplies metal
  /// diffuse, standard, conductor, dielectric: image of normals in tangent space, as in glTF.
  std::string normal_texture;
  double normal_scale = 1; ///< factor of how far these lean
  /// By TextureUse: the texture is a glTF, and this one of its images is meant; -1: neither.
  std::array<int, texture_uses.size()> texture_images{-1, -1, -1, -1, -1};
  TextureWrap texture_wrap = TextureWrap::repeat; ///< of all of them
  Rgb reflectance{1, 1, 1}; ///< mirror, conductor: the same at normal incidence
  /// conductor, dielectric, standard: alpha of GGX is its square, in [0, 1]; none: 0.2, 0, 0.5.
  std::optional<double> roughness;
  double ior = 1.5; ///< dielectric, standard: index of refraction inside over that outside
  double metal = 0; ///< standard: share of the base that is a metal, whose reflectance is albedo
  double coat = 0;  ///< standard: weight of a clear layer on top
  double coat_roughness = 0.05; ///< standard: roughness of that layer
  Rgb absorption{0, 0, 0};      ///< dielectric: absorption coefficient inside [1/world]
  /// dielectric: volumes end at its surface. What absorbs is solid in any case.
  bool solid = false;
  Rgb radiance{1, 1, 1};        ///< emissive [W m^-2 sr^-1]
  std::optional<Rgb> power;     ///< emissive: of all of the surface, in place of radiance [W]
  std::optional<double> kelvin; ///< emissive: its colour is multiplied by that of a black body
  double exposure = 0;          ///< emissive: its strength is multiplied by 2^exposure
  bool two_sided = false;       ///< emissive: shines from the back as well
  /// Colour space of the colours above, to which the texture is converted; not a key of its own.
  ColorSpace color_space = ColorSpace::rec709;
};

/// An image that a material names; `file` is "" where there is none.
struct TextureFile {
  std::string file;
  int image = -1; ///< as in texture_images

  bool operator==(const TextureFile&) const = default;
};
inline constexpr std::array<std::string MaterialSettings::*, texture_uses.size()> texture_members{
    &MaterialSettings::texture, &MaterialSettings::opacity_texture,
    &MaterialSettings::roughness_texture, &MaterialSettings::metal_texture,
    &MaterialSettings::normal_texture};
inline TextureFile texture_file(const MaterialSettings& material, TextureUse use) {
  const auto i = static_cast<std::size_t>(use);
  return {material.*texture_members[i], material.texture_images[i]};
}
inline void set_texture(MaterialSettings& material, TextureUse use, const TextureFile& texture) {
  const auto i = static_cast<std::size_t>(use);
  material.*texture_members[i] = texture.file;
  material.texture_images[i] = texture.image;
}
inline bool has_texture(const MaterialSettings& material) {
  return std::any_of(texture_uses.begin(), texture_uses.end(),
                     [&](TextureUse use) { return !texture_file(material, use).file.empty(); });
}

/// file: triangles of an OBJ, PLY or glTF file. The others are a sphere of radius 1 about the
/// origin, the square from -1 to 1 in x and y, the disk of radius 1 in that plane, all of that
/// plane without an end, the cube from -1 to 1, and the closed cylinder of radius 1 about the z
/// axis from z = -1 to 1; the front of what is flat faces +z. A plane cannot emit.
enum class SurfaceShape { file, sphere, quad, disk, plane, box, cylinder };

struct SurfaceSettings {
  std::string name; ///< in Cryptomatte; empty: mesh0, mesh1, ...
  SurfaceShape shape = SurfaceShape::file;
  std::string file;         ///< path, frame pattern already substituted
  bool file_normals = true; ///< file: shade with the file's normals, if any
  /// file, without normals: triangles that meet at this angle or less [degrees] share a normal;
  /// 0: flat.
  double smooth_angle = 0;
  FileAxes file_axes = FileAxes::same; ///< file: turns it before the transform
  /// file: with the materials of a glTF. A scene that was read has a surface for each of them,
  /// which shows the triangles of one; -1: all.
  bool file_materials = false;
  double file_fps = 24; ///< file: frames per second of the animation of a glTF; time 0 is frame 0
  /// file: time of that animation [seconds], which the scene's frame decides; none: the file has
  /// none.
  std::optional<double> file_seconds;
  int part = -1;
  MaterialSettings material;
  std::string group;   ///< of a surface that shines, as LightSettings::group
  bool visible = true; ///< to the camera; a hidden surface still stops and scatters light
  /// Row-major affine 3x4 matrix from the shape's own space to the world.
  std::array<double, 12> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

} // namespace vdbeam
