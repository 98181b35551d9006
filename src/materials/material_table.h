#pragma once

#include "materials/material.h"

#include <memory>
#include <span>
#include <string_view>

namespace vdbeam {

/// One kind of material: everything that validation, plan, world, help and docs ask about it. It
/// stands in the material's own file; the table below lists it. How light is sampled on it, the
/// material itself answers.
struct MaterialKind {
  std::string_view name; ///< as scene files call it
  std::string_view help; ///< one clause
  /// Keys of [mesh.material] that only this kind, and others that list them, have.
  std::span<const std::string_view> keys = {};
  /// It reflects, absorbs or emits light that is no grey.
  bool (*colored)(const MaterialSettings&) = [](const MaterialSettings&) { return false; };
  /// `scale`: render units per world unit.
  std::unique_ptr<Material> (*make)(const MaterialSettings& settings, double scale);
};

/// Every kind of material, in the order of --help. A new one is its file and a line here.
std::span<const MaterialKind* const> material_table();

/// The kind of a material. Throws InputError for one that is not in the table.
const MaterialKind& material_kind(const MaterialType& type);

extern const MaterialKind diffuse_material, mirror_material, conductor_material, standard_material,
    dielectric_material, emissive_material, holdout_material, shadow_catcher_material;

/// `scale`: render units per world unit. Throws InputError for a kind that is not in the table.
std::unique_ptr<Material> make_material(const MaterialSettings& settings, double scale);

/// A surface of that material is a light.
bool shines(const MaterialSettings& settings);

} // namespace vdbeam
