#include "materials/black.h"

namespace vdbeam {
namespace {

/// Shines with the same radiance in all directions, from its front or from both sides.
class Emissive final : public BlackMaterial {
public:
  explicit Emissive(const MaterialSettings& settings)
      : BlackMaterial(MaterialType::emissive), radiance_(settings.radiance),
        two_sided_(settings.two_sided) {}

  Rgb emitted(bool front) const override { return front || two_sided_ ? radiance_ : Rgb(); }

private:
  Rgb radiance_;
  bool two_sided_;
};

} // namespace

std::unique_ptr<Material> make_emissive(const MaterialSettings& settings, double) {
  return std::make_unique<Emissive>(settings);
}

} // namespace vdbeam
