#include "materials/fresnel.h"
#include "materials/material.h"
#include "materials/microfacets.h"

namespace vdbeam {
namespace {

/// Rough glass: microfacets that reflect and refract (Walter et al. 2007).
class RoughDielectric final : public Material {
public:
  RoughDielectric(const MaterialSettings& settings, double scale)
      : Material(MaterialType::dielectric), ior_(static_cast<float>(settings.ior)),
        absorption_(settings.absorption / static_cast<float>(scale)),
        solid_(settings.solid || max_component(settings.absorption) > 0),
        facets_(roughness_of(settings)), narrow_(vdbeam::shows_surroundings(settings)) {}

  Rgb evaluate(const Vec3f& wo, const Vec3f& wi) const override {
    const Facet f = facet(wo, wi);
    if (!f.possible)
      return {};
    const float common = facets_.distribution(f.h) * facets_.masking(f.wo, upwards(f.wi));
    if (f.wi.z > 0)
      return Rgb(f.reflected * common / (4 * f.wo.z));
    return Rgb((1 - f.reflected) * common * f.cos_o * f.cos_i / (f.wo.z * f.stretch));
  }
  float pdf(const Vec3f& wo, const Vec3f& wi) const override {
    const Facet f = facet(wo, wi);
    if (!f.possible)
      return 0;
    const float visible = facets_.visible_density(f.wo, f.h);
    if (f.wi.z > 0)
      return f.reflected * visible / (4 * f.cos_o);
    return (1 - f.reflected) * visible * f.eta * f.eta * f.cos_i / f.stretch;
  }
  MaterialSample sample(const Vec3f& wo_, Carried carried, Rng& rng) const override {
    const float side = std::copysign(1.0f, wo_.z), eta = side > 0 ? ior_ : 1 / ior_;
    const Vec3f wo = wo_ * Vec3f{1, 1, side};
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f h = facets_.visible_normal(wo, u, v);
    const float cos_o = dot(wo, h);
    float cos_t = 0;
    const float reflected = fresnel_dielectric(std::clamp(cos_o, 0.0f, 1.0f), eta, cos_t);
    const bool reflects = rng.uniform() < reflected;
    Vec3f wi = reflects ? h * (2 * cos_o) - wo : h * (cos_o / eta - cos_t) - wo / eta;
    if (!(cos_o > 0) || !(wo.z > 0) || !(reflects ? wi.z > 0 : wi.z < 0))
      return {};
    wi = normalize(wi);
    const float masked = facets_.masking(wo, upwards(wi)) / facets_.masking(wo);
    // Radiance over the square of the index is what stays constant along a refracted ray.
    const float factor = !reflects && carried == Carried::radiance ? 1 / (eta * eta) : 1;
    wi = wi * Vec3f{1, 1, side};
    return {wi, Rgb(masked * factor), pdf(wo_, wi), factor};
  }
  Rgb absorption() const override { return absorption_; }
  bool is_solid() const override { return solid_; }
  bool shows_surroundings() const override { return narrow_; }

private:
  /// The facets that send light from wi to wo, turned so that wo is above.
  struct Facet {
    Vec3f wo, wi, h;
    float eta = 1;              ///< index on the far side over that on the side of wo
    float cos_o = 0, cos_i = 0; ///< of the angles at the facet
    float stretch = 1;          ///< (wo h + eta wi h)^2: of solid angles by refraction
    float reflected = 0;        ///< share of the light (Fresnel)
    bool possible = false;
  };

  static Vec3f upwards(const Vec3f& w) { return {w.x, w.y, std::abs(w.z)}; }

  Facet facet(const Vec3f& wo, const Vec3f& wi) const {
    const float side = std::copysign(1.0f, wo.z);
    Facet f{wo * Vec3f{1, 1, side}, wi * Vec3f{1, 1, side}, {}};
    f.eta = side > 0 ? ior_ : 1 / ior_;
    const bool reflects = f.wi.z > 0;
    const Vec3f sum = f.wo + f.wi * (reflects ? 1 : f.eta);
    if (!(f.wo.z > 0) || f.wi.z == 0 || !(dot(sum, sum) > 0))
      return f;
    f.h = normalize(sum);
    f.h = f.h * std::copysign(1.0f, f.h.z);
    const float o = dot(f.wo, f.h), i = dot(f.wi, f.h);
    f.possible = o > 0 && (reflects ? i > 0 : i < 0);
    f.cos_o = o;
    f.cos_i = std::abs(i);
    f.stretch = (o + f.eta * i) * (o + f.eta * i);
    float cos_t = 0;
    f.reflected = fresnel_dielectric(std::clamp(o, 0.0f, 1.0f), f.eta, cos_t);
    return f;
  }

  float ior_;
  Rgb absorption_;
  bool solid_;
  Microfacets facets_;
  bool narrow_;
};

} // namespace

std::unique_ptr<Material> make_rough_dielectric(const MaterialSettings& settings, double scale) {
  return std::make_unique<RoughDielectric>(settings, scale);
}

} // namespace vdbeam
