#include "materials/material_table.h"
#include "math/color.h"

namespace vdbeam {
namespace {

/// Reflects on both sides, the same share at every angle.
class Mirror final : public Material {
public:
  explicit Mirror(const MaterialSettings& settings) : reflectance_(settings.reflectance) {}

  Rgb evaluate(const Vec3f&, const Vec3f&) const override { return {}; }
  float pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  MaterialSample sample(const Vec3f& wo, Carried, Rng&) const override { return reflected(wo); }
  SpecularBranches branches(const Vec3f& wo, Carried) const override { return {reflected(wo), {}}; }
  bool is_specular() const override { return true; }
  bool is_black() const override { return max_component(reflectance_) <= 0; }

private:
  MaterialSample reflected(const Vec3f& wo) const {
    return {{-wo.x, -wo.y, wo.z}, reflectance_, 0, 1};
  }

  Rgb reflectance_;
};

constexpr std::string_view mirror_keys[] = {"reflectance"};

} // namespace

const MaterialKind mirror_material{
    .name = "mirror",
    .help = "perfect mirror, on both sides",
    .keys = mirror_keys,
    .colored = [](const MaterialSettings& settings) { return !is_grey(settings.reflectance); },
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<Mirror>(settings);
    }};

} // namespace vdbeam
