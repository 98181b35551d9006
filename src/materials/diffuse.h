#pragma once

#include "materials/material.h"

#include <cmath>

namespace vdbeam {

/// The albedo of a diffuse surface; where none is given a texture is shown as it is.
inline Rgb albedo_of(const MaterialSettings& settings) {
  return settings.albedo.value_or(settings.texture.empty() ? Rgb(0.8f) : Rgb(1));
}

/// Its albedo is no grey, or may be none.
bool has_colored_albedo(const MaterialSettings& settings);

/// Lambert's law on both sides: f = albedo / pi.
class Diffuse : public Material {
public:
  explicit Diffuse(const MaterialSettings& settings) : albedo_(albedo_of(settings)) {}

  Rgb evaluate(const Vec3f& wo, const Vec3f& wi) const override {
    return wo.z * wi.z > 0 ? albedo_ * (std::abs(wi.z) / pi) : Rgb();
  }
  float pdf(const Vec3f& wo, const Vec3f& wi) const override {
    return wo.z * wi.z > 0 ? std::abs(wi.z) / pi : 0;
  }
  MaterialSample sample(const Vec3f& wo, Carried, Rng& rng) const override {
    const float u = rng.uniform_positive(), phi = 2 * pi * rng.uniform();
    const float cosine = std::sqrt(u), sine = std::sqrt(std::max(0.0f, 1 - u));
    const Vec3f wi{sine * std::cos(phi), sine * std::sin(phi), std::copysign(cosine, wo.z)};
    return {wi, albedo_, cosine / pi, 1};
  }
  Rgb matt(const Vec3f& wo, const Vec3f& wi) const override { return evaluate(wo, wi); }
  Rgb matt_albedo(const Vec3f&) const override { return albedo_; }
  bool is_all_matt() const override { return true; }
  Rgb guide_albedo() const override { return albedo_; }
  bool is_black() const override { return max_component(albedo_) <= 0; }

private:
  Rgb albedo_;
};

} // namespace vdbeam
