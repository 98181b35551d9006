#pragma once

#include "vdb/vdb_reader.h"

#include <string>
#include <utility>

namespace vdbeam {

/// The OpenVDB side of reading. Everything here may hang, crash or throw on a malformed file, and
/// uses no thread but its own, so that it can run in a forked child process.

/// Makes a value that is never destroyed. Files and grids are such in the child: OpenVDB would
/// deallocate them through TBB, whose other threads do not exist there and may have left its locks
/// held.
template <class T, class... Arguments>
T& make_immortal(Arguments&&... arguments) {
  return *new T(std::forward<Arguments>(arguments)...);
}

/// Registers OpenVDB's grid types; must be called before the fork.
void prepare_openvdb();

/// The grid's name as the file writes it: where no grid has the name, the only one that differs
/// from it in capitals alone. Throws InputError where a file has no such grid, or one of another
/// type or map than can be rendered.
std::string require_density_grid(const std::string& path, const std::string& grid_name);

/// Reads one grid, or what is wanted of it, and writes it to `descriptor`, laid out as
/// RawGridHeader says. Throws InputError (no such grid, unsupported type, class, map or
/// background), and whatever OpenVDB throws.
void write_raw_grid(const std::string& path, const std::string& grid_name, Background background,
                    const std::optional<WantedBox>& wanted, int descriptor);

/// Writes the names of a file's grids, each ended by a line feed.
void write_grid_names(const std::string& path, int descriptor);

/// Writes the GridSummary of a grid that could be rendered, as far as the file's metadata give it:
/// no voxels are read unless the file lacks statistics. Throws as write_raw_grid.
void write_header(const std::string& path, const std::string& grid_name, int descriptor);

/// Reads one grid of any type and writes its GridSummary (see vdb_reader.h) as CBOR.
void write_summary(const std::string& path, const std::string& grid_name, int descriptor);

} // namespace vdbeam
