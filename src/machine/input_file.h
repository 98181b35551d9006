#pragma once

#include "machine/mapped_file.h"

#include <cstdint>
#include <string>

namespace vdbeam {

/// A file that is open for reading.
struct InputFile {
  Descriptor descriptor;
  std::uint64_t bytes = 0; ///< its size, not 0
};

/// Opens a file that is about to be parsed. Throws InputError where there is none, it is not a
/// regular file or may not be read, and FrameError where it is empty: another program may still be
/// writing it.
InputFile open_input_file(const std::string& path);

/// Tells one state of a file from another: its path, size and time of change; of a file that is not
/// there the path.
std::string file_identity(const std::string& path);

} // namespace vdbeam
