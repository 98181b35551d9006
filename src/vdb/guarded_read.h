#pragma once

#include "machine/mapped_file.h"
#include "vdb/vdb_reader.h"

#include <functional>

namespace vdbeam {

/// Lets a child process run `write`, which reads the VDB and writes to the descriptor it is given,
/// within the limits; gives back what it wrote. Throws as read_density_grid.
MappedFile read_guarded(const std::string& path, const ReadLimits& limits,
                        const std::function<void(int descriptor)>& write);

} // namespace vdbeam
