#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace vdbeam {

/// Linear light, 0 to 1, of an sRGB code, 0 to 1, and its inverse (IEC 61966-2-1).
inline double light_of_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}
inline double srgb_of_light(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}
/// In single precision, which takes a third of the time.
inline float srgb_of_light(float light) {
  return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
}
/// Light of the codes of 8 bits.
inline std::array<float, 256> light_of_bytes() {
  std::array<float, 256> light{};
  for (std::size_t code = 0; code < light.size(); ++code)
    light[code] = static_cast<float>(light_of_srgb(static_cast<double>(code) / 255));
  return light;
}

} // namespace vdbeam
