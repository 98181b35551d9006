#include "materials/diffuse.h"
#include "materials/material_table.h"

namespace vdbeam {
namespace {

/// The ground of a plate: a diffuse surface to all light but that of the camera, which sees of it
/// only the shadows that fall on it, as alpha.
class ShadowCatcher final : public Diffuse {
public:
  using Diffuse::Diffuse;
  bool is_shadow_catcher() const override { return true; }
};

constexpr std::string_view shadow_catcher_keys[] = {"albedo", "texture", "texture_wrap"};

} // namespace

const MaterialKind shadow_catcher_material{
    .name = "shadow_catcher",
    .help = "diffuse for light; the camera sees only the shadows on it, as alpha",
    .keys = shadow_catcher_keys,
    .colored = has_colored_albedo,
    .make = [](const MaterialSettings& settings, double) -> std::unique_ptr<Material> {
      return std::make_unique<ShadowCatcher>(settings);
    }};

} // namespace vdbeam
