#include "materials/black.h"
#include "materials/material_table.h"

namespace vdbeam {
namespace {

/// Stands for an object that is composited later: black and without alpha to the camera, it hides
/// what is behind it and casts its shadow.
class Holdout final : public BlackMaterial {
public:
  bool is_holdout() const override { return true; }
};

constexpr std::string_view holdout_keys[] = {"opacity", "opacity_texture", "opacity_cutoff",
                                             "texture_wrap"};

} // namespace

const MaterialKind holdout_material{
    .name = "holdout",
    .help = "black with alpha 0, for an object that is composited later",
    .keys = holdout_keys,
    .make = [](const MaterialSettings&, double) -> std::unique_ptr<Material> {
      return std::make_unique<Holdout>();
    }};

} // namespace vdbeam
