#pragma once

#include "film/film.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// Fills in the film's number of passes and its error estimate; the other fields are left
/// unchanged. `unbiased`: the estimator has no bias.
PassRecord error_record(const Film& film, bool unbiased);

} // namespace vdbeam
