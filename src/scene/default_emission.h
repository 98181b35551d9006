#pragma once

#include "vdb/vdb_reader.h"
#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Whether simulators give this name to what burns or is hot; capitals do not matter.
bool is_fire_grid(const std::string& name);

/// How a bare VDB glows, from the summaries of the files that decide: by its flame grid ("flame",
/// "flames", "fire", "heat", "burn"), in the colours of its temperature grid if there is one; or by
/// a temperature grid that is plainly in kelvin. No emission where there is neither. `notes` takes
/// what was chosen; `path` is for them.
EmissionSettings default_emission(const std::string& path,
                                  const std::vector<std::vector<GridSummary>>& summaries,
                                  std::vector<std::string>& notes);

/// x rounded to `digits` significant digits; 1 unless x is positive and finite.
double round_to_digits(double x, int digits);

} // namespace vdbeam
