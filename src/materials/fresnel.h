#pragma once

#include "vdbeam/vec.h"

namespace vdbeam {

/// Share of unpolarised light that a smooth dielectric reflects (Fresnel's equations).
/// `cos_i` in [0, 1]: cosine of incidence; `eta`: index on the far side over that on the near side.
/// Sets `cos_t` to the cosine of refraction, 0 at total reflection, for which the share is 1.
inline float fresnel_dielectric(float cos_i, float eta, float& cos_t) {
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) {
    cos_t = 0;
    return 1;
  }
  cos_t = std::sqrt(1 - sin2_t);
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float across = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + across * across);
}

/// Schlick's approximation for conductors (1994), from the colour at normal incidence.
inline Rgb fresnel_schlick(const Rgb& normal, float cosine) {
  const float m = std::min(std::max(1 - cosine, 0.0f), 1.0f), m2 = m * m;
  return normal + (Rgb(1) - normal) * (m2 * m2 * m);
}

} // namespace vdbeam
