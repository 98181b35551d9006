#pragma once

#include "vdbeam/kinds.h"

namespace vdbeam {

struct PhaseSettings {
  PhaseType type = PhaseType::isotropic;
  double g = 0;                 ///< mean cosine (first lobe), in (-1, 1)
  double g2 = 0;                ///< two_lobe: mean cosine of the second lobe
  double blend = 0.5;           ///< two_lobe: weight of the second lobe
  double droplet_diameter = 20; ///< mie: micrometres, 5 to 50

  bool operator==(const PhaseSettings&) const = default;
};

} // namespace vdbeam
