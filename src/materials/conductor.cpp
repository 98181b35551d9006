#include "materials/fresnel.h"
#include "materials/material_table.h"
#include "materials/microfacets.h"
#include "math/color.h"

namespace vdbeam {
namespace {

/// Rough metal on both sides.
class Conductor final : public Material {
public:
  Conductor(const MaterialSettings& settings, double roughness)
      : reflectance_(settings.reflectance), facets_(roughness), narrow_(is_narrow(roughness)) {}

  Rgb evaluate(const Vec3f& wo_, const Vec3f& wi_) const override {
    if (!(wo_.z * wi_.z > 0))
      return {};
    const Vec3f wo = upwards(wo_), wi = upwards(wi_), h = normalize(wo + wi);
    return fresnel_schlick(reflectance_, dot(wo, h)) *
           (facets_.distribution(h) * facets_.masking(wo, wi) / (4 * wo.z));
  }
  float pdf(const Vec3f& wo_, const Vec3f& wi_) const override {
    if (!(wo_.z * wi_.z > 0))
      return 0;
    const Vec3f wo = upwards(wo_), h = normalize(wo + upwards(wi_));
    return facets_.distribution(h) / ((1 + facets_.lambda(wo)) * 4 * wo.z);
  }
  MaterialSample sample(const Vec3f& wo_, Carried, Rng& rng) const override {
    const Vec3f wo = upwards(wo_);
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f h = facets_.visible_normal(wo, u, v);
    Vec3f wi = h * (2 * dot(wo, h)) - wo;
    if (!(wi.z > 0) || !(wo.z > 0))
      return {};
    const float masked = (1 + facets_.lambda(wo)) / (1 + facets_.lambda(wo) + facets_.lambda(wi));
    const Rgb weight = fresnel_schlick(reflectance_, dot(wo, h)) * masked;
    const float density = pdf(wo, wi);
    wi.z = std::copysign(wi.z, wo_.z);
    return {wi, weight, density, 1};
  }
  bool is_black() const override { return max_component(reflectance_) <= 0; }
  bool shows_surroundings() const override { return narrow_ && !is_black(); }
  bool throws_light() const override { return !is_black(); }

private:
  static Vec3f upwards(const Vec3f& w) { return {w.x, w.y, std::abs(w.z)}; }

  Rgb reflectance_;
  Microfacets facets_;
  bool narrow_;
};

constexpr std::string_view conductor_keys[] = {
    "reflectance",    "roughness",       "roughness_texture", "texture_wrap", "opacity",
    "opacity_cutoff", "opacity_texture", "normal_texture",    "normal_scale"};
/// Where the scene gives none: metal is a little rough.
constexpr double default_roughness = 0.2;

} // namespace

const MaterialKind conductor_material{
    .name = "conductor",
    .help = "metal, smooth or rough (GGX)",
    .keys = conductor_keys,
    .colored = [](const MaterialSettings& settings) { return !is_grey(settings.reflectance); },
    .make = [](const MaterialSettings& settings, double scale) -> std::unique_ptr<Material> {
      const double roughness = settings.roughness.value_or(default_roughness);
      // A perfectly smooth one is a mirror.
      if (!(roughness > 0))
        return mirror_material.make(settings, scale);
      return std::make_unique<Conductor>(settings, roughness);
    }};

} // namespace vdbeam
