#include "materials/black.h"
#include "materials/material_table.h"
#include "math/color.h"
#include "volume/blackbody.h"

namespace vdbeam {
namespace {

/// Shines with the same radiance in all directions, from its front or from both sides.
class Emissive final : public BlackMaterial {
public:
  /// With a power, which the world replaces by a radiance once it knows the surface's area, it
  /// shines by some other amount, if at all.
  explicit Emissive(const MaterialSettings& settings)
      : radiance_(settings.power.value_or(settings.radiance) *
                  light_tint(settings.kelvin, settings.exposure, settings.color_space)),
        two_sided_(settings.two_sided) {}

  Rgb emitted(bool front) const override { return front || two_sided_ ? radiance_ : Rgb(); }

private:
  Rgb radiance_;
  bool two_sided_;
};

constexpr std::string_view emissive_keys[] = {"radiance",  "power",   "kelvin",      "exposure",
                                              "two_sided", "texture", "texture_wrap"};

} // namespace

const MaterialKind emissive_material{
    .name = "emissive",
    .help = "an area light of constant radiance; reflects nothing",
    .keys = emissive_keys,
    .colored =
        [](const MaterialSettings& settings) {
          return !is_grey(settings.radiance) || !is_grey(settings.power.value_or(Rgb(1))) ||
                 settings.kelvin || !settings.texture.empty();
        },
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<Emissive>(settings);
    }};

} // namespace vdbeam
