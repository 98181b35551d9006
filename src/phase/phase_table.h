#pragma once

#include "phase/phase_function.h"
#include "text/key_complaint.h"

#include <optional>
#include <span>
#include <string_view>

namespace vdbeam {

/// One phase function: everything that validation, plan, world, help and docs ask about it. It
/// stands in a file of its own, with its formula; the table below lists it.
struct PhaseKind {
  std::string_view name; ///< as scene files call it
  std::string_view help; ///< one clause
  /// Keys of [volume.phase] that only this one, and others that list them, have.
  std::span<const std::string_view> keys = {};
  /// Complaint about settings that no phase function can have.
  std::optional<KeyComplaint> (*complaint)(const PhaseSettings&) = [](const PhaseSettings&) {
    return std::optional<KeyComplaint>();
  };
  /// For settings without a complaint.
  PhaseLobes (*lobes)(const PhaseSettings&);
};

/// Every phase function, in the order of --help. A new one is its file and a line here.
std::span<const PhaseKind* const> phase_table();

/// The kind of a phase function. Throws InputError for one that is not in the table.
const PhaseKind& phase_kind(const PhaseType& type);

extern const PhaseKind isotropic_phase, henyey_greenstein_phase, rayleigh_phase, two_lobe_phase,
    mie_phase;

/// A complaint where `value`, of `key`, is not inside (-1, 1), in single precision too: rounded to
/// 1, the lobe of that mean cosine is a delta function.
std::optional<KeyComplaint> mean_cosine_complaint(const char* key, double value);
/// A complaint where `value`, of `key`, lies outside [lower, upper].
std::optional<KeyComplaint> range_complaint(const char* key, double value, double lower,
                                            double upper);

} // namespace vdbeam
