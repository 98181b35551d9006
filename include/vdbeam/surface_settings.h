#pragma once

#include "vdbeam/camera_settings.h"
#include "vdbeam/color_space.h"
#include "vdbeam/kinds.h"
#include "vdbeam/vec.h"

#include <array>
#include <optional>
#include <string>

namespace vdbeam {

/// Texture lookup beyond the edges of the image.
enum class TextureWrap { repeat, mirror, clamp };

struct MaterialSettings {
  MaterialType type = MaterialType::diffuse;
  /// diffuse, standard, shadow_catcher: share of the light that is reflected, per channel; none:
  /// 0.8, or 1 where there is a texture.
  std::optional<Rgb> albedo;
  /// diffuse, standard, shadow_catcher, emissive: image that multiplies albedo or radiance; "":
  /// none
  std::string texture;
  int texture_image = -1; ///< texture is a glTF, and this one of its images is meant; -1: neither
  TextureWrap texture_wrap = TextureWrap::repeat;
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
