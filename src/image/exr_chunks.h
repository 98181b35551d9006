#pragma once

#include <ImfMultiPartInputFile.h>

#include <string>

namespace vdbeam {

/// Refuses a part of a size that the file cannot hold, for which memory would be taken. Throws
/// InputError.
void check_part_fits_file(const Imf::Header& header, const std::string& path);

/// Refuses what OpenEXR reads without a word: a part that check_part_fits_file refuses, and a chunk
/// that unpacks to fewer bytes than its pixels need, for which OpenEXR passes on whatever its
/// memory held before. The part is complete and flat, and none of its channels is subsampled.
/// Throws InputError; passes on the exceptions of OpenEXR.
void check_chunks(Imf::MultiPartInputFile& file, int part, const std::string& path);

} // namespace vdbeam
