#include "materials/material.h"

#include "vdbeam/error.h"

namespace vdbeam {

const std::vector<MaterialKind>& material_table() {
  static const std::vector<MaterialKind> table{
      {MaterialType::diffuse, "diffuse", make_diffuse},
      {MaterialType::mirror, "mirror", make_mirror},
      {MaterialType::conductor, "conductor", make_conductor},
      {MaterialType::dielectric, "dielectric", make_dielectric},
      {MaterialType::emissive, "emissive", make_emissive},
      {MaterialType::holdout, "holdout", make_holdout},
      {MaterialType::shadow_catcher, "shadow_catcher", make_shadow_catcher},
  };
  return table;
}

std::unique_ptr<Material> make_material(const MaterialSettings& settings, double scale) {
  for (const MaterialKind& kind : material_table())
    if (kind.type == settings.type)
      return kind.make(settings, scale);
  throw InputError("unknown material");
}

} // namespace vdbeam
