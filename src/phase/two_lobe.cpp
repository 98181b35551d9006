#include "phase/phase_table.h"

namespace vdbeam {
namespace {

constexpr std::string_view two_lobe_keys[] = {"g", "g2", "blend"};

std::optional<KeyComplaint> complaint(const PhaseSettings& phase) {
  if (auto blend = range_complaint("blend", phase.blend, 0, 1))
    return blend;
  if (auto first = mean_cosine_complaint("g", phase.g))
    return first;
  return mean_cosine_complaint("g2", phase.g2);
}

} // namespace

/// A blend of two Henyey-Greenstein lobes: (1 - blend) of the mean cosine g, blend of g2.
const PhaseKind two_lobe_phase{.name = "two_lobe",
                               .help = "a blend of two Henyey-Greenstein lobes",
                               .keys = two_lobe_keys,
                               .complaint = complaint,
                               .lobes = [](const PhaseSettings& phase) -> PhaseLobes {
                                 return {DraineLobe{.g = static_cast<float>(phase.g),
                                                    .weight = static_cast<float>(1 - phase.blend)},
                                         DraineLobe{.g = static_cast<float>(phase.g2),
                                                    .weight = static_cast<float>(phase.blend)}};
                               }};

} // namespace vdbeam
