#pragma once

#include "film/film_file.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// Why a checkpoint does not hold the first of these passes of a render, whose own file would say
/// `own`; empty where it does.
std::string why_not_resumable(const FilmFileInfo& info, const FilmFileInfo& own,
                              const PassRange& passes);

} // namespace vdbeam
