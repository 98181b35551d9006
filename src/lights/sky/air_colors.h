#pragma once

#include "lights/sky/atmosphere.h"
#include "vdbeam/light_settings.h"
#include "volume/blackbody.h"

#include <memory>

namespace vdbeam {

/// The air of a light of the type `atmosphere` or `sun`; `up`: the camera's.
AirSettings air_of(const LightSettings& settings, const Vec3d& up);

/// The atmosphere for these settings; the last one is kept.
std::shared_ptr<const Atmosphere> atmosphere_of(const AirSettings& air);

/// Colours of the working space; what it cannot show counts as 0.
class AirColors {
public:
  explicit AirColors(const LightSettings& settings)
      : scale_(settings.irradiance), space_(settings.color_space),
        matrix_(rgb_matrix(chromaticities_of(ColorSpace::rec709), chromaticities_of(space_))) {}

  /// Radiance, or irradiance, of the light's strength.
  Rgb operator()(const Vec3d& xyz) const { return scale_ * Rgb(max(rgb(xyz), Vec3d(0))); }
  /// The same for a sun of luminance 1; negative where the space cannot show the colour.
  Vec3d rgb(const Vec3d& xyz) const {
    const Vec3d rec709 = xyz_to_rgb(xyz);
    return space_ == ColorSpace::rec709 ? rec709 : matrix_.apply(rec709);
  }

private:
  Rgb scale_;
  ColorSpace space_;
  ColorMatrix matrix_;
};

} // namespace vdbeam
