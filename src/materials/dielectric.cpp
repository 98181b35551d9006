#include "materials/fresnel.h"
#include "materials/material.h"

namespace vdbeam {
namespace {

/// Smooth glass or water: reflects and refracts by Fresnel's and Snell's laws.
class Dielectric final : public Material {
public:
  Dielectric(const MaterialSettings& settings, double scale)
      : Material(MaterialType::dielectric), ior_(static_cast<float>(settings.ior)),
        absorption_(settings.absorption / static_cast<float>(scale)),
        solid_(settings.solid || max_component(settings.absorption) > 0) {}

  Rgb evaluate(const Vec3f&, const Vec3f&) const override { return {}; }
  float pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  MaterialSample sample(const Vec3f& wo, Carried carried, Rng& rng) const override {
    const float eta = wo.z > 0 ? ior_ : 1 / ior_, cos_o = std::abs(wo.z);
    float cos_t = 0;
    const float reflected = fresnel_dielectric(cos_o, eta, cos_t);
    if (rng.uniform() < reflected)
      return {{-wo.x, -wo.y, wo.z}, Rgb(1), 0, 1};
    const Vec3f wi{-wo.x / eta, -wo.y / eta, std::copysign(cos_t, -wo.z)};
    // Radiance over the square of the index is what stays constant along a refracted ray.
    const float factor = carried == Carried::radiance ? 1 / (eta * eta) : 1;
    return {normalize(wi), Rgb(factor), 0, factor};
  }
  bool is_specular() const override { return true; }
  Rgb absorption() const override { return absorption_; }
  bool is_solid() const override { return solid_; }

private:
  float ior_;
  Rgb absorption_;
  bool solid_;
};

} // namespace

std::unique_ptr<Material> make_dielectric(const MaterialSettings& settings, double scale) {
  // Facets of index 1 bend no light, whatever their slope.
  if (roughness_of(settings) > 0 && std::abs(settings.ior - 1) > 1e-4)
    return make_rough_dielectric(settings, scale);
  return std::make_unique<Dielectric>(settings, scale);
}

} // namespace vdbeam
