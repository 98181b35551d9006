#include "materials/material_table.h"

#include <array>

namespace vdbeam {

// This list stands alone in its file, so that a program may link another in its place.
std::span<const MaterialKind* const> material_table() {
  static constexpr std::array table{
      &diffuse_material,    &standard_material, &mirror_material,  &conductor_material,
      &dielectric_material, &emissive_material, &holdout_material, &shadow_catcher_material};
  return table;
}

} // namespace vdbeam
