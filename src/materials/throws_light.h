#pragma once

#include "materials/material.h"

namespace vdbeam {

/// Sends light on in a narrow lobe, or in single directions: mirrors, metal and glass, smooth or
/// rough. A path that scatters elsewhere rarely finds where such a surface shows it a lamp or the
/// sun, and is bright then: photons bring that light to other surfaces.
inline bool throws_light(const Material& material) {
  return !material.is_black() &&
         (material.type() == MaterialType::mirror || material.type() == MaterialType::conductor ||
          material.type() == MaterialType::dielectric);
}

} // namespace vdbeam
