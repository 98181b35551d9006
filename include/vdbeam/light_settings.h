#pragma once

#include "vdbeam/color_space.h"
#include "vdbeam/kinds.h"
#include "vdbeam/vec.h"

#include <optional>
#include <string>

namespace vdbeam {

/// How single scattering of a light is found: by shadow rays, or from photons.
enum class DirectLight { automatic, sampled, photons };

/// A [[light]] of a scene, in world units; docs/reference/scene.md has unit, range and
/// default. Each kind of light reads the fields whose comments name it, and those that name none.
struct LightSettings {
  LightType type = LightType::distant;
  Vec3d direction{0, -1, 0}; ///< the way the light travels
  /// distant: on a plane that faces the light; atmosphere, sun: the same above the air [W m^-2]
  Rgb irradiance{1, 1, 1};
  double angular_radius = 0; ///< distant: half angle of the disc, degrees
  Vec3d position{0, 0, 0};   ///< point, spot
  Rgb intensity{1, 1, 1};    ///< point, spot: in the strongest direction [W sr^-1]
  std::optional<Rgb> power;  ///< point, spot: in all directions, in place of intensity [W]
  double cone_angle = 30;    ///< spot: half angle where the light ends, degrees
  double cone_falloff = 5;   ///< spot: width of the smooth edge inside it, degrees
  std::string ies;           ///< point, spot: LM-63 file with its photometric profile, or empty
  Rgb radiance{1, 1, 1};     ///< environment: constant, or the image's factor; sky: factor
  Rgb zenith{0.07f, 0.19f, 0.52f};  ///< sky: radiance straight up
  Rgb horizon{0.44f, 0.56f, 0.72f}; ///< sky: radiance at the horizon
  Rgb ground{0.15f, 0.15f, 0.145f}; ///< sky: radiance from below the horizon
  double aerosol = 0.1;             ///< atmosphere, sun: optical depth of haze straight up, 550 nm
  double ground_albedo = 0.2;       ///< atmosphere, sun: share of light that the ground reflects
  double altitude = 0;              ///< atmosphere, sun: of the camera above the ground [m]
  /// atmosphere: length of a world unit [m], for the air between camera and scene; none: no air.
  /// `altitude` is then that of the world's origin.
  std::optional<double> metres_per_unit;
  bool sun = true;   ///< atmosphere: a scene file's has a light `sun` with it
  std::string image; ///< environment: lat-long EXR or HDR, empty: constant; spot: projected
  /// Colour space of the colours above, to which images are converted; not a key of its own.
  ColorSpace color_space = ColorSpace::rec709;
  /// Degrees; environment: about the up axis; point and spot: profile and image about direction.
  double rotation = 0;
  std::optional<double> kelvin;      ///< its colour is multiplied by that of a black body
  double exposure = 0;               ///< its strength is multiplied by 2^exposure
  bool visible = true;               ///< to the camera; a hidden light still lights the medium
  std::string group;                 ///< of lights that share a layer; empty: none
  std::optional<DirectLight> direct; ///< overrides render.direct for this light
};

} // namespace vdbeam
