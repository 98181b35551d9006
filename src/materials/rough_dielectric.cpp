#include "materials/rough_dielectric.h"

#include "materials/fresnel.h"
#include "materials/microfacets.h"

namespace vdbeam {
namespace {

/// Rough glass: microfacets that reflect and refract (Walter et al. 2007).
class RoughDielectric final : public Material {
public:
  RoughDielectric(const MaterialSettings& settings, double roughness, double scale)
      : ior_(static_cast<float>(settings.ior)),
        absorption_(settings.absorption / static_cast<float>(scale)),
        solid_(settings.solid || max_component(settings.absorption) > 0), facets_(roughness),
        narrow_(is_narrow(roughness)) {}

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
  MaterialSample sample(const Vec3f& wo, Carried carried, Rng& rng) const override {
    const FacetDraw facet = draw(wo, rng);
    return by(facet, wo, rng.uniform() < facet.reflected, carried);
  }
  SpecularBranches both_ways(const Vec3f& wo, Carried carried, Rng& rng) const override {
    const FacetDraw facet = draw(wo, rng);
    SpecularBranches ways{by(facet, wo, true, carried), by(facet, wo, false, carried)};
    ways.reflected.weight *= facet.reflected;
    ways.refracted.weight *= 1 - facet.reflected;
    return ways;
  }
  Rgb absorption() const override { return absorption_; }
  bool is_solid() const override { return solid_; }
  bool shows_surroundings() const override { return narrow_; }
  bool throws_light() const override { return true; }
  bool refracts() const override { return true; }

private:
  /// A facet that is seen from wo, drawn at random; wo is turned so that it is above.
  struct FacetDraw {
    Vec3f wo, h;
    float side = 1, eta = 1;    ///< of wo, and the index on the far side over that on its side
    float cos_o = 0, cos_t = 0; ///< of the angles at the facet
    float reflected = 0;        ///< share of the light (Fresnel)
  };
  FacetDraw draw(const Vec3f& wo, Rng& rng) const {
    FacetDraw f;
    f.side = std::copysign(1.0f, wo.z);
    f.eta = f.side > 0 ? ior_ : 1 / ior_;
    f.wo = wo * Vec3f{1, 1, f.side};
    const float u = rng.uniform(), v = rng.uniform();
    f.h = facets_.visible_normal(f.wo, u, v);
    f.cos_o = dot(f.wo, f.h);
    f.reflected = fresnel_dielectric(std::clamp(f.cos_o, 0.0f, 1.0f), f.eta, f.cos_t);
    return f;
  }
  /// Where the facet reflects or refracts to, weighted as if nothing went the other way.
  MaterialSample by(const FacetDraw& f, const Vec3f& wo, bool reflects, Carried carried) const {
    Vec3f wi =
        reflects ? f.h * (2 * f.cos_o) - f.wo : f.h * (f.cos_o / f.eta - f.cos_t) - f.wo / f.eta;
    if (!(f.cos_o > 0) || !(f.wo.z > 0) || !(reflects ? wi.z > 0 : wi.z < 0))
      return {};
    wi = normalize(wi);
    const float masked = facets_.masking(f.wo, upwards(wi)) / facets_.masking(f.wo);
    // Radiance over the square of the index is what stays constant along a refracted ray.
    const float factor = !reflects && carried == Carried::radiance ? 1 / (f.eta * f.eta) : 1;
    wi = wi * Vec3f{1, 1, f.side};
    return {wi, Rgb(masked * factor), pdf(wo, wi), factor};
  }

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

std::unique_ptr<Material> make_rough_dielectric(const MaterialSettings& settings, double roughness,
                                                double scale) {
  return std::make_unique<RoughDielectric>(settings, roughness, scale);
}

} // namespace vdbeam
