#pragma once

#include "vdbeam/color_space.h"

#include <string>

namespace vdbeam {

/// Dependence of a black body's brightness on its temperature.
enum class EmissionLaw { planck, stefan_boltzmann, none };

/// Light that a volume emits: j(x) = scale * color * intensity(x) * blackbody(x) [radiance /
/// world], where intensity is 1 without an intensity grid and blackbody is 1 without a temperature
/// grid (docs/theory/transport.md).
struct EmissionSettings {
  std::string intensity;   ///< grid name; empty: none
  std::string temperature; ///< grid name; empty: none
  double kelvin = 1;       ///< temperature [K] = kelvin * grid value + kelvin_offset
  double kelvin_offset = 0;
  EmissionLaw law = EmissionLaw::planck;
  double reference = 1500; ///< the temperature [K] at which the blackbody's luminance is 1
  Rgb color{1, 1, 1};
  std::string ramp; ///< colours by value, "x:r,g,b ...", instead of a black body's; empty: none
  ColorSpace color_space = ColorSpace::rec709; ///< of black bodies; no key: the working space
  double scale = 1; ///< radiance per world unit where intensity, color and black body are all 1

  /// True where the settings can give any emission.
  bool glows() const {
    return (!intensity.empty() || !temperature.empty()) && scale > 0 && max_component(color) > 0;
  }
};

} // namespace vdbeam
