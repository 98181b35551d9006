#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// The OpenVDB side of reading velocities, for a child process (see vdb_parse.h).

/// Writes the names of the grids that hold a file's velocity, each ended by a line feed: one of
/// vectors, or three of numbers. `wanted` is one name, three with commas between them, or "auto",
/// for which nothing is written where the file has none. Throws InputError.
void write_velocity_names(const std::string& path, const std::string& wanted, int descriptor);

/// Writes one component of a grid of vectors, or a grid of numbers, laid out as RawGridHeader says;
/// voxels that are not active are NaN.
void write_raw_component(const std::string& path, const std::string& name, int component,
                         int descriptor);

} // namespace vdbeam
