#include "phase/phase_table.h"

namespace vdbeam {
namespace {

constexpr std::string_view henyey_greenstein_keys[] = {"g"};

} // namespace

/// Henyey and Greenstein, *Diffuse Radiation in the Galaxy* (1941):
///   p(cos) = 1 / (4 pi) * (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2)
/// The mean cosine is g: 0 is isotropic, towards 1 light goes straight on, towards -1 back.
const PhaseKind henyey_greenstein_phase{
    .name = "henyey_greenstein",
    .help = "one forward or backward lobe",
    .keys = henyey_greenstein_keys,
    .complaint = [](const PhaseSettings& phase) { return mean_cosine_complaint("g", phase.g); },
    .lobes = [](const PhaseSettings& phase) -> PhaseLobes {
      return {DraineLobe{.g = static_cast<float>(phase.g)}};
    }};

} // namespace vdbeam
