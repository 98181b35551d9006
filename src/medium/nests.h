#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vdbeam {

/// Volumes that are small against the rest of the medium, by their numbers: a cloud in a wide layer
/// of fog. The first nest holds the smallest volumes, and each further one those of the nest before
/// it, too. Empty where all volumes are about equally large. Photons that are spread evenly over
/// the medium, or equal blocks of a table, would hardly find a nest.
using Nests = std::vector<std::vector<std::size_t>>;

/// `areas`: surface area of each volume's box.
Nests find_nests(std::span<const double> areas);

} // namespace vdbeam
