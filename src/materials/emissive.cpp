#include "materials/black.h"
#include "materials/material_table.h"
#include "math/color.h"

namespace vdbeam {
namespace {

/// Shines with the same radiance in all directions, from its front or from both sides.
class Emissive final : public BlackMaterial {
public:
  explicit Emissive(const MaterialSettings& settings)
      : radiance_(settings.radiance), two_sided_(settings.two_sided) {}

  Rgb emitted(bool front) const override { return front || two_sided_ ? radiance_ : Rgb(); }

private:
  Rgb radiance_;
  bool two_sided_;
};

constexpr std::string_view keys[] = {"radiance", "two_sided", "texture", "texture_wrap"};

} // namespace

const MaterialKind emissive_material{
    .name = "emissive",
    .help = "an area light of constant radiance; reflects nothing",
    .keys = keys,
    .colored =
        [](const MaterialSettings& settings) {
          return !is_grey(settings.radiance) || !settings.texture.empty();
        },
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<Emissive>(settings);
    }};

} // namespace vdbeam
