#pragma once

#include "vdb/vdb_reader.h"

#include <optional>
#include <string>

namespace vdbeam {

/// Properties that decide whether a grid can be rendered as a density.
struct GridKind {
  std::string value_type; ///< "float", "half", "double", ...
  std::string map_type;   ///< "UniformScaleMap", "NonlinearFrustumMap", ...
  bool linear = true;     ///< whether the map is affine
  bool level_set = false;
  double background = 0;
};

/// True for a grid whose class says so.
bool is_level_set(const GridSummary& grid);

GridKind kind_of(const GridSummary& grid);

/// Why such a grid cannot be rendered as a density, as the rest of a sentence that begins with its
/// name; nothing where it can. Reading a file and `vdbeam info` both decide by this.
std::optional<std::string> why_no_density(const GridKind& kind);

} // namespace vdbeam
