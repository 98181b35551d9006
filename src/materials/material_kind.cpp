#include "materials/material_table.h"
#include "vdbeam/error.h"

#include <fmt/core.h>

namespace vdbeam {

const MaterialKind& material_kind(const MaterialType& type) {
  for (const MaterialKind* kind : material_table())
    if (kind->name == type.name)
      return *kind;
  throw InputError(fmt::format("material.type: there is no material \"{}\"", type.name));
}

std::unique_ptr<Material> make_material(const MaterialSettings& settings, double scale) {
  return material_kind(settings.type).make(settings, scale);
}

bool shines(const MaterialSettings& settings) {
  return make_material(settings, 1)->shines();
}

} // namespace vdbeam
