#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// The OpenVDB side of reading grids of vectors, for a child process (see vdb_parse.h).

/// Meaning of the vectors of a grid.
enum class VectorMeaning { velocity, color };

/// Writes the names of the grids that hold a file's vectors, each ended by a line feed: one of
/// vectors, or three of numbers. `wanted` is one name, three with commas between them, or "auto":
/// the usual names of such grids, where nothing is written if the file has none. Throws InputError.
void write_vector_names(const std::string& path, const std::string& wanted, VectorMeaning meaning,
                        int descriptor);

/// Writes one component of a grid of vectors, or a grid of numbers, laid out as RawGridHeader says;
/// voxels that are not active are NaN.
void write_raw_component(const std::string& path, const std::string& name, int component,
                         VectorMeaning meaning, int descriptor);

} // namespace vdbeam
