#pragma once

#include "vdbeam/image.h"

#include <cstdint>
#include <string>

namespace vdbeam {

/// Limits that are checked before pixels are allocated: no file asks for more than 4 GiB.
inline constexpr std::int64_t max_image_side = std::int64_t{1} << 20;
inline constexpr std::int64_t max_image_pixels = std::int64_t{1} << 28;
inline constexpr std::int64_t max_image_values = std::int64_t{1} << 30;

/// Throws InputError: this file is no readable image of this kind. The reason may quote the file.
[[noreturn]] void not_readable(const std::string& path, const char* kind,
                               const std::string& reason);

/// Refuses an image of `bytes` bytes of pixels if its file cannot hold them, a byte of the file
/// standing for at most `most_per_byte` of them. Throws InputError.
void check_size_fits_file(const std::string& path, double bytes, double most_per_byte);

/// A flat EXR of any pixel types, its data window placed in its display window (0 outside); the
/// first part of several. Y alone becomes R, G, B too. Throws InputError.
Image read_exr(const std::string& path);

/// A Radiance RGBE picture, flat or run-length encoded, in any of the eight orientations; EXPOSURE
/// and PRIMARIES lines: the former is divided out, the latter ignored. Throws InputError.
Image read_hdr(const std::string& path);

/// A PNG of 8 or 16 bits, decoded to linear light; 8 bits are sRGB where the file has no gamma of
/// its own. Alpha is left out. Throws InputError.
Image read_png(const std::string& path);

/// A JPEG in grey or colour, its codes read as sRGB: colour profiles and the orientation that a
/// camera has noted are ignored. Throws InputError.
Image read_jpeg(const std::string& path);

/// The version of OpenEXR, e.g. "3.1.5".
std::string exr_library_version();

} // namespace vdbeam
