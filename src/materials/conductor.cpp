#include "materials/fresnel.h"
#include "materials/material.h"

#include <cmath>

namespace vdbeam {
namespace {

/// Rough metal on both sides: microfacets of the GGX distribution (Walter et al. 2007) with Smith's
/// height-correlated masking, sampled by visible normals (Heitz 2018).
class Conductor final : public Material {
public:
  explicit Conductor(const MaterialSettings& settings)
      : Material(MaterialType::conductor), reflectance_(settings.reflectance),
        // Of smoother ones single precision cannot tell the peak from its surroundings.
        alpha_(std::max(1e-3f, static_cast<float>(settings.roughness * settings.roughness))) {}

  Rgb evaluate(const Vec3f& wo_, const Vec3f& wi_) const override {
    if (!(wo_.z * wi_.z > 0))
      return {};
    const Vec3f wo = upwards(wo_), wi = upwards(wi_), h = normalize(wo + wi);
    const float masking = 1 / (1 + lambda(wo) + lambda(wi));
    return fresnel_schlick(reflectance_, dot(wo, h)) * (distribution(h) * masking / (4 * wo.z));
  }
  float pdf(const Vec3f& wo_, const Vec3f& wi_) const override {
    if (!(wo_.z * wi_.z > 0))
      return 0;
    const Vec3f wo = upwards(wo_), h = normalize(wo + upwards(wi_));
    return distribution(h) / ((1 + lambda(wo)) * 4 * wo.z);
  }
  MaterialSample sample(const Vec3f& wo_, Carried, Rng& rng) const override {
    const Vec3f wo = upwards(wo_);
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f h = visible_normal(wo, u, v);
    Vec3f wi = h * (2 * dot(wo, h)) - wo;
    if (!(wi.z > 0) || !(wo.z > 0))
      return {};
    const float masked = (1 + lambda(wo)) / (1 + lambda(wo) + lambda(wi));
    const Rgb weight = fresnel_schlick(reflectance_, dot(wo, h)) * masked;
    const float density = pdf(wo, wi);
    wi.z = std::copysign(wi.z, wo_.z);
    return {wi, weight, density, 1};
  }
  bool is_black() const override { return max_component(reflectance_) <= 0; }

private:
  static Vec3f upwards(const Vec3f& w) { return {w.x, w.y, std::abs(w.z)}; }
  float distribution(const Vec3f& h) const {
    const float a2 = alpha_ * alpha_;
    // 1 - cos^2 from the sine, which keeps its digits near the peak.
    const float d = (h.x * h.x + h.y * h.y) + a2 * h.z * h.z;
    return a2 / (pi * d * d);
  }
  float lambda(const Vec3f& w) const {
    const float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (std::sqrt(1 + alpha_ * alpha_ * tan2) - 1);
  }
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

  Rgb reflectance_;
  float alpha_;
};

} // namespace

std::unique_ptr<Material> make_conductor(const MaterialSettings& settings, double scale) {
  // A perfectly smooth one is a mirror.
  return settings.roughness > 0 ? std::make_unique<Conductor>(settings)
                                : make_mirror(settings, scale);
}

} // namespace vdbeam
