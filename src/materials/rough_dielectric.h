#pragma once

#include "materials/material.h"

#include <memory>

namespace vdbeam {

/// Glass of this roughness, which is greater than 0. `scale`: render units per world unit.
std::unique_ptr<Material> make_rough_dielectric(const MaterialSettings& settings, double roughness,
                                                double scale);

} // namespace vdbeam
