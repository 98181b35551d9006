#include "phase/phase_table.h"

namespace vdbeam {

/// Particles much smaller than a wavelength, without polarisation:
///   p(cos) = 3 / (16 pi) * (1 + cos^2)
const PhaseKind rayleigh_phase{
    .name = "rayleigh",
    .help = "particles much smaller than the wavelength, as in air",
    .lobes = [](const PhaseSettings&) -> PhaseLobes { return {DraineLobe{.g = 0, .alpha = 1}}; }};

} // namespace vdbeam
