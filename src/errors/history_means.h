#pragma once

#include "errors/pass_history.h"

#include <vector>

namespace vdbeam {

/// Added to the brightness in the denominator of MRSE.
inline constexpr double mrse_offset = 0.01;

/// Passes of all complete batches.
double total_passes(const PassHistory& history);
/// The mean of all complete batches, R, G, B of each followed pixel.
std::vector<float> mean_of(const PassHistory& history, double passes);
/// Mean over the 3 x 3 followed pixels around each; the border repeats.
std::vector<float> smoothed(const std::vector<float>& means, int columns, int rows);

} // namespace vdbeam
