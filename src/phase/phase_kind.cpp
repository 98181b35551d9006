#include "phase/phase_table.h"
#include "vdbeam/error.h"

#include <fmt/core.h>

#include <cmath>

namespace vdbeam {

const PhaseKind& phase_kind(const PhaseType& type) {
  for (const PhaseKind* kind : phase_table())
    if (kind->name == type.name)
      return *kind;
  throw InputError(fmt::format("phase.type: there is no phase function \"{}\"", type.name));
}

std::optional<KeyComplaint> mean_cosine_complaint(const char* key, double value) {
  if (std::abs(value) < 1 && std::abs(static_cast<float>(value)) < 1)
    return std::nullopt;
  return KeyComplaint{key, fmt::format("must lie in (-1, 1), got {}", value)};
}

std::optional<KeyComplaint> range_complaint(const char* key, double value, double lower,
                                            double upper) {
  if (value >= lower && value <= upper)
    return std::nullopt;
  return KeyComplaint{key, fmt::format("must lie in [{}, {}], got {}", lower, upper, value)};
}

} // namespace vdbeam
