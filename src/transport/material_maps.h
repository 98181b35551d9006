#pragma once

#include "geometry/surface_set.h"
#include "image/texture.h"
#include "materials/material.h"

#include <memory>
#include <vector>

namespace vdbeam {

/// The material of a surface whose roughness or metal differs from place to place. A point has one
/// of two neighbours in a list of materials, drawn by its place so that the mean over points around
/// it is linear in between.
class MaterialMaps {
public:
  /// `scale`: render units per world unit. A texture may be null.
  MaterialMaps(const MaterialSettings& settings, double scale,
               std::shared_ptr<const Texture> roughness, std::shared_ptr<const Texture> metal);

  const Material& at(const SurfaceHit& hit) const;
  /// Every material that a point may have.
  const std::vector<std::unique_ptr<Material>>& materials() const { return materials_; }

private:
  /// Roughness takes this many steps from 0 to 1.
  static constexpr int steps = 32;

  std::shared_ptr<const Texture> roughness_texture_, metal_texture_;
  float roughness_, metal_;
  int first_step_ = 0, count_ = 0;                   ///< of the roughness that there is
  std::vector<std::unique_ptr<Material>> materials_; ///< by roughness; then those that are metal
};

} // namespace vdbeam
