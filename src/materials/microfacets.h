#pragma once

#include "math/ray.h"

#include <cmath>

namespace vdbeam {

/// Whether lobes of that roughness are so narrow that few photons arrive from where the surface
/// shows light from: it shows a picture of its surroundings, if a blurred one.
constexpr bool is_narrow(double roughness) {
  return roughness < 0.55; // GGX alpha 0.3
}

/// Microfacets of the GGX distribution (Walter et al. 2007) with Smith's height-correlated masking,
/// sampled by visible normals (Heitz 2018). Directions are in the surface's frame, z up.
class Microfacets {
public:
  /// `roughness` in (0, 1]; alpha is its square.
  explicit Microfacets(double roughness)
      // Single precision does not resolve the peak of smoother surfaces.
      : alpha_(std::max(1e-3f, static_cast<float>(roughness * roughness))) {}

  /// Density of facets with normal h, by their area seen from above.
  float distribution(const Vec3f& h) const {
    const float a2 = alpha_ * alpha_;
    // 1 - cos^2 from the sine, which keeps its digits near the peak.
    const float d = (h.x * h.x + h.y * h.y) + a2 * h.z * h.z;
    return a2 / (pi * d * d);
  }
  /// Area of the facets that are not seen from w over that of those that are.
  float lambda(const Vec3f& w) const {
    const float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (std::sqrt(1 + alpha_ * alpha_ * tan2) - 1);
  }
  /// Share of the facets that are seen from w.
  float masking(const Vec3f& w) const { return 1 / (1 + lambda(w)); }
  /// Share of the facets that are seen from both.
  float masking(const Vec3f& a, const Vec3f& b) const { return 1 / (1 + lambda(a) + lambda(b)); }
  /// Density with which visible_normal draws h.
  float visible_density(const Vec3f& wo, const Vec3f& h) const {
    return distribution(h) * masking(wo) * std::abs(dot(wo, h)) / std::abs(wo.z);
  }
  /// A normal as it is seen from wo, which is above.
  Vec3f visible_normal(const Vec3f& wo, float u, float v) const {
    const Vec3f w = normalize(Vec3f{alpha_ * wo.x, alpha_ * wo.y, wo.z});
    const float across = w.x * w.x + w.y * w.y;
    const Vec3f t1 = across > 0 ? Vec3f{-w.y, w.x, 0} / std::sqrt(across) : Vec3f{1, 0, 0};
    const Vec3f t2 = cross(w, t1);
    const float r = std::sqrt(u), phi = 2 * pi * v, s = 0.5f * (1 + w.z);
    const float p1 = r * std::cos(phi);
    const float p2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - p1 * p1)) + s * r * std::sin(phi);
    const float p3 = std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
    const Vec3f n = t1 * p1 + t2 * p2 + w * p3;
    return normalize(Vec3f{alpha_ * n.x, alpha_ * n.y, std::max(1e-6f, n.z)});
  }

private:
  float alpha_;
};

} // namespace vdbeam
