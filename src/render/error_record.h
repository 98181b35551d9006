#pragma once

#include "film/film.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// The film's passes and what they tell about its error; the rest of the record is left alone.
/// `unbiased`: the estimator has no bias.
PassRecord error_record(const Film& film, bool unbiased);

} // namespace vdbeam
