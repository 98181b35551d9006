#include "phase/phase_table.h"

#include <cmath>

namespace vdbeam {
namespace {

constexpr std::string_view mie_keys[] = {"droplet_diameter"};

PhaseLobes lobes(const PhaseSettings& phase) {
  const double diameter = phase.droplet_diameter;
  const double g_hg = std::exp(-0.0990567 / (diameter - 1.67154));
  const double g_d = std::exp(-2.20679 / (diameter + 3.91029) - 0.428934);
  const double alpha = std::exp(3.62489 - 8.29288 / (diameter + 5.52825));
  const double w_d = std::exp(-0.599085 / (diameter - 0.641583) - 0.665888);
  return {DraineLobe{static_cast<float>(g_hg), 0, static_cast<float>(1 - w_d)},
          DraineLobe{static_cast<float>(g_d), static_cast<float>(alpha), static_cast<float>(w_d)}};
}

} // namespace

/// Jendersie and d'Eon, "An Approximate Mie Scattering Function for Fog and Cloud Rendering",
/// SIGGRAPH 2023 Talks, eqs. 4-7: fits for water droplets of 5 to 50 micrometres, a
/// Henyey-Greenstein lobe with the weight 1 - w_d and Draine's with the weight w_d.
const PhaseKind mie_phase{.name = "mie",
                          .help = "water droplets, as in fog and clouds",
                          .keys = mie_keys,
                          .complaint =
                              [](const PhaseSettings& phase) {
                                return range_complaint("droplet_diameter", phase.droplet_diameter,
                                                       5, 50);
                              },
                          .lobes = lobes};

} // namespace vdbeam
