#include "materials/diffuse.h"

namespace vdbeam {
namespace {

/// The ground of a plate: a diffuse surface to all light but that of the camera, which sees of it
/// only the shadows that fall on it, as alpha.
class ShadowCatcher final : public Diffuse {
public:
  using Diffuse::Diffuse;
  bool is_shadow_catcher() const override { return true; }
};

} // namespace

std::unique_ptr<Material> make_shadow_catcher(const MaterialSettings& settings, double) {
  return std::make_unique<ShadowCatcher>(settings);
}

} // namespace vdbeam
