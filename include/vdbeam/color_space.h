#pragma once

#include "vdbeam/vec.h"

namespace vdbeam {

/// Scene-linear RGB spaces in which light may be rendered and written.
enum class ColorSpace {
  rec709,    ///< Rec.709 and sRGB primaries, white D65 (ITU-R BT.709)
  rec2020,   ///< ITU-R BT.2020, white D65
  acescg,    ///< AP1 primaries, white of ACES (S-2014-004)
  aces2065_1 ///< AP0 primaries, white of ACES (SMPTE ST 2065-1)
};

/// CIE 1931 x and y of the primaries and of white.
struct Chromaticities {
  double red_x = 0.64, red_y = 0.33, green_x = 0.30, green_y = 0.60, blue_x = 0.15, blue_y = 0.06,
         white_x = 0.3127, white_y = 0.3290;

  /// The same but for the digits that files have.
  bool is_near(const Chromaticities& other) const;
};

Chromaticities chromaticities_of(ColorSpace space);

/// A linear map of colours.
struct ColorMatrix {
  Vec3d red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}; ///< rows

  Vec3d apply(const Vec3d& c) const { return {dot(red, c), dot(green, c), dot(blue, c)}; }
};

/// Linear RGB of one space to that of another. White stays white: where the spaces' whites differ
/// colours are adapted by Bradford's transform (Lam 1985; ICC.1:2022, annex E).
ColorMatrix rgb_matrix(const Chromaticities& from, const Chromaticities& to);

} // namespace vdbeam
