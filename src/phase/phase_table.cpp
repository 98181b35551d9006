#include "phase/phase_table.h"

#include <array>

namespace vdbeam {

// This list stands alone in its file, so that a program may link another in its place.
std::span<const PhaseKind* const> phase_table() {
  static constexpr std::array table{&isotropic_phase, &henyey_greenstein_phase, &rayleigh_phase,
                                    &two_lobe_phase, &mie_phase};
  return table;
}

} // namespace vdbeam
