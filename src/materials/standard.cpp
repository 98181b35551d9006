#include "materials/diffuse.h"
#include "materials/fresnel.h"
#include "materials/material_table.h"
#include "materials/microfacets.h"
#include "math/color.h"

#include <array>

namespace vdbeam {
namespace {

/// A function of the cosine of a direction, linear between entries that lie closer at the horizon.
class CosineTable {
public:
  static constexpr std::size_t size = 48;

  template <class Function>
  explicit CosineTable(const Function& function) {
    for (std::size_t i = 0; i < size; ++i)
      values_[i] = function(cosine(i));
    // The mean over what a diffuse surface sends out: 2 f(mu) mu dmu.
    constexpr int steps = 1024;
    for (int i = 0; i < steps; ++i) {
      const float mu = (static_cast<float>(i) + 0.5f) / steps;
      mean_ += (*this)(mu)*2 * mu / steps;
    }
  }

  float operator()(float mu) const {
    const float place = std::sqrt(std::clamp(mu, 0.0f, 1.0f)) * (size - 1);
    const auto i = std::min(static_cast<std::size_t>(place), size - 2);
    return values_[i] + (values_[i + 1] - values_[i]) * (place - static_cast<float>(i));
  }
  float mean() const { return mean_; }

private:
  static float cosine(std::size_t i) {
    const float root = std::max(static_cast<float>(i), 0.1f) / (size - 1);
    return root * root;
  }

  std::array<float, size> values_{};
  float mean_ = 0;
};

/// A glossy layer: microfacets of a dielectric.
struct GlossyLayer {
  Microfacets facets;
  float ior;

  float fresnel(float cosine) const {
    float cos_t = 0;
    return fresnel_dielectric(std::clamp(cosine, 0.0f, 1.0f), ior, cos_t);
  }
  /// Mean of value(wi) weighted by what the facets, were they mirrors, send from wo to wi: f |cos|
  /// integrated over wi.
  template <class Value>
  float integrate(float mu, const Value& value) const {
    constexpr int across = 24;
    const Vec3f wo{std::sqrt(std::max(0.0f, 1 - mu * mu)), 0, mu};
    float sum = 0;
    for (int i = 0; i < across * across; ++i) {
      const float u = (static_cast<float>(i / across) + 0.5f) / across,
                  v = (static_cast<float>(i % across) + 0.5f) / across;
      const Vec3f h = facets.visible_normal(wo, u, v);
      const Vec3f wi = h * (2 * dot(wo, h)) - wo;
      if (wi.z > 0)
        sum += facets.masking(wo, wi) / facets.masking(wo) * value(wi, dot(wo, h));
    }
    return sum / (across * across);
  }
};

/// A coat over a base that is a metal, or diffuse under a glossy layer, or a mixture; on both
/// sides. The layers below get what those above let in and out, which conserves energy and can be
/// exchanged: with the share A(mu) of light that the glossy layers reflect all in all, the diffuse
/// base is albedo / pi (1 - A(mu_o)) (1 - A(mu_i)) / (1 - mean A) (Shirley et al., A Practitioners'
/// Assessment of Light Reflection Models, 1997; Kelemen and Szirmay-Kalos 2001).
class Standard final : public Material {
public:
  explicit Standard(const MaterialSettings& settings, double roughness)
      : base_(albedo_of(settings)), metal_(static_cast<float>(settings.metal)),
        coat_(static_cast<float>(settings.coat)), gloss_{Microfacets(roughness), ior_of(settings)},
        coating_{Microfacets(settings.coat_roughness), coat_ior},
        narrow_metal_(is_narrow(roughness) && settings.metal > 0.5), coated_([this](float mu) {
          return coat_ > 0 ? coat_ * coating_.integrate(mu,
                                                        [&](const Vec3f&, float cosine) {
                                                          return coating_.fresnel(cosine);
                                                        })
                           : 0;
        }),
        glossy_([this](float mu) {
          return coated_(mu) +
                 (1 - coated_(mu)) * gloss_.integrate(mu, [&](const Vec3f& wi, float cosine) {
                   return gloss_.fresnel(cosine) * (1 - coated_(wi.z));
                 });
        }) {}

  Rgb evaluate(const Vec3f& wo, const Vec3f& wi) const override {
    Rgb by_texture, rest;
    return scatter(wo, wi, by_texture, rest) ? by_texture + rest : Rgb();
  }
  Rgb untextured(const Vec3f& wo, const Vec3f& wi) const override {
    Rgb by_texture, rest;
    return scatter(wo, wi, by_texture, rest) ? rest : Rgb();
  }
  float pdf(const Vec3f& wo_, const Vec3f& wi_) const override {
    if (!(wo_.z * wi_.z > 0))
      return 0;
    const Vec3f wo = upwards(wo_), wi = upwards(wi_);
    const Chances chances = chances_of(wo.z);
    return chances.coat * lobe_pdf(coating_.facets, wo, wi) +
           chances.gloss * lobe_pdf(gloss_.facets, wo, wi) + chances.diffuse * wi.z / pi;
  }
  MaterialSample sample(const Vec3f& wo_, Carried, Rng& rng) const override {
    const Vec3f wo = upwards(wo_);
    const Chances chances = chances_of(wo.z);
    const float lobe = rng.uniform(), u = rng.uniform_positive(), v = rng.uniform();
    Vec3f wi;
    if (lobe < chances.diffuse) {
      const float sine = std::sqrt(std::max(0.0f, 1 - u)), phi = 2 * pi * v;
      wi = {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(u)};
    } else {
      const bool coat = lobe < chances.diffuse + chances.coat;
      const Vec3f h = (coat ? coating_ : gloss_).facets.visible_normal(wo, u, v);
      wi = h * (2 * dot(wo, h)) - wo;
    }
    if (!(wi.z > 0) || !(wo.z > 0))
      return {};
    wi.z = std::copysign(wi.z, wo_.z);
    Rgb by_texture, rest;
    const float density = pdf(wo_, wi);
    if (!(density > 0) || !scatter(wo_, wi, by_texture, rest))
      return {};
    MaterialSample sample{wi, (by_texture + rest) / density, density, 1};
    sample.untextured = rest / density;
    return sample;
  }
  Rgb matt(const Vec3f& wo, const Vec3f& wi) const override {
    return wo.z * wi.z > 0 ? diffuse(std::abs(wo.z), std::abs(wi.z)) : Rgb();
  }
  Rgb matt_albedo(const Vec3f& wo) const override {
    return base_ * ((1 - metal_) * (1 - glossy_(std::abs(wo.z))));
  }
  Rgb guide_albedo() const override { return base_; }
  bool shows_surroundings() const override { return narrow_metal_; }
  bool throws_light() const override { return metal_ > 0.5f; }

private:
  static constexpr float coat_ior = 1.5f;

  static Vec3f upwards(const Vec3f& w) { return {w.x, w.y, std::abs(w.z)}; }
  /// Below 1 the layer would reflect totally: its inverse has the same reflectance from above.
  static float ior_of(const MaterialSettings& settings) {
    return static_cast<float>(std::max(settings.ior, 1 / settings.ior));
  }
  static float lobe_pdf(const Microfacets& facets, const Vec3f& wo, const Vec3f& wi) {
    const Vec3f h = normalize(wo + wi);
    return facets.distribution(h) / ((1 + facets.lambda(wo)) * 4 * wo.z);
  }
  /// D G / (4 cos): f |cos(wi)| over the Fresnel factor.
  static float lobe(const Microfacets& facets, const Vec3f& wo, const Vec3f& wi, const Vec3f& h) {
    return facets.distribution(h) * facets.masking(wo, wi) / (4 * wo.z);
  }

  /// f |cos(wi)| of the diffuse base, by the cosines of the directions.
  Rgb diffuse(float mu_o, float mu_i) const {
    return base_ * ((1 - metal_) * (1 - glossy_(mu_o)) * (1 - glossy_(mu_i)) /
                    (1 - glossy_.mean()) * mu_i / pi);
  }
  /// f |cos(wi)|: the part that is proportional to the colour of the base, which a texture
  /// multiplies, and the rest. False where there is neither.
  bool scatter(const Vec3f& wo_, const Vec3f& wi_, Rgb& by_texture, Rgb& rest) const {
    if (!(wo_.z * wi_.z > 0))
      return false;
    const Vec3f wo = upwards(wo_), wi = upwards(wi_), h = normalize(wo + wi);
    const float cosine = dot(wo, h), below = (1 - coated_(wo.z)) * (1 - coated_(wi.z));
    const float gloss = below * lobe(gloss_.facets, wo, wi, h);
    const float grazing = fresnel_schlick(Rgb(0), cosine).x; // (1 - cos)^5
    by_texture = diffuse(wo.z, wi.z) + base_ * (metal_ * gloss * (1 - grazing));
    const float coat =
        coat_ > 0 ? coat_ * coating_.fresnel(cosine) * lobe(coating_.facets, wo, wi, h) : 0;
    rest = Rgb(coat + gloss * ((1 - metal_) * gloss_.fresnel(cosine) + metal_ * grazing));
    return true;
  }

  /// Chances of the lobes, about the shares of the light that they reflect.
  struct Chances {
    float diffuse, coat, gloss;
  };
  Chances chances_of(float mu) const {
    const float base = max_component(base_), coat = coated_(mu);
    const float metal = metal_ * (1 - coat) * (base + (1 - base) * gloss_.fresnel(mu));
    Chances chances{(1 - metal_) * (1 - glossy_(mu)) * base, coat,
                    (1 - metal_) * (glossy_(mu) - coat) + metal};
    constexpr float least = 1e-3f; // of a black base seen straight on
    chances.gloss = std::max(chances.gloss, least);
    const float sum = chances.diffuse + chances.coat + chances.gloss;
    return {chances.diffuse / sum, chances.coat / sum, chances.gloss / sum};
  }

  Rgb base_;
  float metal_, coat_;
  GlossyLayer gloss_, coating_;
  bool narrow_metal_;
  CosineTable coated_; ///< share of the light that the coat reflects
  CosineTable glossy_; ///< that all layers over a diffuse base do
};

constexpr std::string_view standard_keys[] = {"albedo",
                                              "texture",
                                              "texture_wrap",
                                              "roughness",
                                              "roughness_texture",
                                              "metal",
                                              "ior",
                                              "coat",
                                              "coat_roughness",
                                              "metal_texture",
                                              "opacity",
                                              "opacity_texture",
                                              "opacity_cutoff",
                                              "normal_texture",
                                              "normal_scale"};
constexpr double default_roughness = 0.5;

} // namespace

const MaterialKind standard_material{
    .name = "standard",
    .help = "plastic, paint or metal: a diffuse base under a glossy layer, a metal, and a coat",
    .keys = standard_keys,
    .colored = has_colored_albedo,
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<Standard>(settings, settings.roughness.value_or(default_roughness));
    }};

} // namespace vdbeam
