#pragma once

#include "vdbeam/color_space.h"

#include <optional>

namespace vdbeam {

/// The CIE 1931 colour matching functions x, y and z at a wavelength in nanometres, interpolated
/// linearly between steps of 10; 0 outside of 380 to 780.
Vec3d color_matching(double nanometres);

/// Tristimulus values of a black body's radiance (Planck 1901): X, Y and Z of the CIE 1931 standard
/// observer [W / m^2 / sr, weighed without a unit], summed from 380 to 780 nm. `kelvin` > 0.
Vec3d planck_xyz(double kelvin);

/// Linear RGB with Rec.709 primaries and white D65 from X, Y, Z (IEC 61966-2-1).
Vec3d xyz_to_rgb(const Vec3d& xyz);

/// The luminance (Y) of linear RGB with Rec.709 primaries.
double luminance(const Vec3d& rgb);

/// The colour of a black body with luminance 1. Below about 1900 K it lies outside of what Rec.709
/// can show: components below 0 count as 0, and the luminance is made 1 again. The other spaces
/// hold it down to 900 K and less. Temperatures below 500 K and above 50,000 K have the colour of
/// those.
Vec3d blackbody_color(double kelvin, ColorSpace space = ColorSpace::rec709);

/// The factor that the keys `kelvin` and `exposure` of a light stand for: 2^exposure times the
/// colour of a black body of that temperature, or white, with luminance 1.
Rgb light_tint(const std::optional<double>& kelvin, double exposure, ColorSpace space);

/// planck_xyz(kelvin).y / planck_xyz(reference).y, without overflow or underflow on the way. From
/// a table with a relative error below 1e-4 from 500 to 50,000 K, with the laws of Wien and of
/// Rayleigh and Jeans beyond; 0 for kelvin <= 0.
double blackbody_luminance(double kelvin, double reference);

} // namespace vdbeam
