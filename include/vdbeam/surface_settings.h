#pragma once

#include "vdbeam/vec.h"

#include <array>
#include <string>

namespace vdbeam {

/// What a surface looks like; docs/physics.md has the models.
enum class MaterialType { diffuse, mirror, conductor, dielectric, emissive, holdout };

struct MaterialSettings {
  MaterialType type = MaterialType::diffuse;
  Rgb albedo{0.8f, 0.8f, 0.8f}; ///< diffuse: share of the light that is reflected, per channel
  Rgb reflectance{1, 1, 1};     ///< mirror, conductor: the same at normal incidence
  double roughness = 0.2;       ///< conductor: alpha of GGX is its square, in [0, 1]
  double ior = 1.5;             ///< dielectric: index of refraction inside over that outside
  Rgb absorption{0, 0, 0};      ///< dielectric: absorption coefficient inside [1/world]
  /// dielectric: volumes end at its surface. What absorbs is solid in any case.
  bool solid = false;
  Rgb radiance{1, 1, 1};  ///< emissive [W m^-2 sr^-1]
  bool two_sided = false; ///< emissive: shines from the back as well
};

inline bool shines(const MaterialSettings& material) {
  return material.type == MaterialType::emissive && max_component(material.radiance) > 0;
}

/// Sends light on in single directions only.
inline bool is_specular(const MaterialSettings& material) {
  return material.type == MaterialType::mirror || material.type == MaterialType::dielectric ||
         (material.type == MaterialType::conductor && material.roughness == 0);
}

/// file: triangles of an OBJ, PLY or glTF file. The others are a sphere of radius 1 about the
/// origin, the square from -1 to 1 in x and y, and the disk of radius 1 in that plane; the front of
/// the latter two faces +z.
enum class SurfaceShape { file, sphere, quad, disk };

struct SurfaceSettings {
  SurfaceShape shape = SurfaceShape::file;
  std::string file; ///< path, frame pattern already substituted
  MaterialSettings material;
  bool visible = true; ///< to the camera; a hidden surface still stops and scatters light
  /// Row-major affine 3x4 matrix from the shape's own space to the world.
  std::array<double, 12> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

} // namespace vdbeam
