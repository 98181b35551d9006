#include "materials/fresnel.h"
#include "materials/material_table.h"
#include "materials/rough_dielectric.h"
#include "math/color.h"

namespace vdbeam {
namespace {

/// Smooth glass or water: reflects and refracts by Fresnel's and Snell's laws.
class Dielectric final : public Material {
public:
  Dielectric(const MaterialSettings& settings, double scale)
      : ior_(static_cast<float>(settings.ior)),
        absorption_(settings.absorption / static_cast<float>(scale)),
        solid_(settings.solid || max_component(settings.absorption) > 0) {}

  Rgb evaluate(const Vec3f&, const Vec3f&) const override { return {}; }
  float pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  MaterialSample sample(const Vec3f& wo, Carried carried, Rng& rng) const override {
    const Interface at(wo, ior_);
    return rng.uniform() < at.reflected ? reflection(wo) : refraction(wo, at, carried);
  }
  SpecularBranches branches(const Vec3f& wo, Carried carried) const override {
    const Interface at(wo, ior_);
    SpecularBranches ways{reflection(wo), {}};
    ways.reflected.weight *= at.reflected;
    if (at.reflected < 1) {
      ways.refracted = refraction(wo, at, carried);
      ways.refracted.weight *= 1 - at.reflected;
    }
    return ways;
  }
  bool is_specular() const override { return true; }
  bool refracts() const override { return true; }
  Rgb absorption() const override { return absorption_; }
  bool is_solid() const override { return solid_; }

private:
  struct Interface {
    Interface(const Vec3f& wo, float ior)
        : eta(wo.z > 0 ? ior : 1 / ior),
          reflected(fresnel_dielectric(std::abs(wo.z), eta, cos_refracted)) {}

    float eta; ///< index on the far side over that on the side of wo
    float cos_refracted = 0;
    float reflected; ///< share of the light (Fresnel)
  };

  static MaterialSample reflection(const Vec3f& wo) { return {{-wo.x, -wo.y, wo.z}, Rgb(1), 0, 1}; }
  static MaterialSample refraction(const Vec3f& wo, const Interface& at, Carried carried) {
    const Vec3f wi{-wo.x / at.eta, -wo.y / at.eta, std::copysign(at.cos_refracted, -wo.z)};
    // Radiance over the square of the index is what stays constant along a refracted ray.
    const float factor = carried == Carried::radiance ? 1 / (at.eta * at.eta) : 1;
    return {normalize(wi), Rgb(factor), 0, factor};
  }

  float ior_;
  Rgb absorption_;
  bool solid_;
};

constexpr std::string_view dielectric_keys[] = {
    "roughness", "ior", "absorption", "solid", "normal_texture", "normal_scale", "texture_wrap"};

} // namespace

const MaterialKind dielectric_material{
    .name = "dielectric",
    .help = "glass or water, smooth or rough (GGX): reflects and refracts",
    .keys = dielectric_keys,
    .colored = [](const MaterialSettings& settings) { return !is_grey(settings.absorption); },
    .make = [](const MaterialSettings& settings, double scale) -> std::unique_ptr<Material> {
      const double roughness = settings.roughness.value_or(0); // glass is smooth
      // Facets of index 1 bend no light, whatever their slope.
      if (roughness > 0 && std::abs(settings.ior - 1) > 1e-4)
        return make_rough_dielectric(settings, roughness, scale);
      return std::make_unique<Dielectric>(settings, scale);
    }};

} // namespace vdbeam
