#pragma once

#include "materials/material.h"

namespace vdbeam {

/// Base of materials that reflect nothing.
class BlackMaterial : public Material {
public:
  Rgb evaluate(const Vec3f&, const Vec3f&) const override { return {}; }
  float pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  MaterialSample sample(const Vec3f&, Carried, Rng&) const override { return {}; }
  bool is_specular() const override { return true; }
  bool is_black() const override { return true; }
};

} // namespace vdbeam
