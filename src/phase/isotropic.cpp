#include "phase/phase_table.h"

namespace vdbeam {

/// All directions alike: p = 1 / (4 pi).
const PhaseKind isotropic_phase{
    .name = "isotropic",
    .help = "isotropic scattering",
    .lobes = [](const PhaseSettings&) -> PhaseLobes { return {DraineLobe{.g = 0, .alpha = 0}}; }};

} // namespace vdbeam
