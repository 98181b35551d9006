#pragma once

#include "vdbeam/deep_image.h"
#include "vdbeam/image.h"

#include <string>

namespace vdbeam {

/// Writes an EXR (ZIP, half colour, float data) under a temporary name beside `path`, syncs and
/// renames, so that `path` is never half written. Throws FrameError (disk full, no permission).
void write_exr(const Image& image, const std::string& path);

/// Writes a deep EXR of scan lines (ZIPS, half colour, float A, Z and ZBack) in the same way, with
/// the windows and attributes of `attributes`. Returns its size in bytes. Throws FrameError.
std::uint64_t write_deep_exr(const DeepImage& deep, const Image& attributes,
                             const std::string& path);

/// Reads every channel of a flat EXR as float, or an RGBE .hdr or a PNG as linear R, G, B. Throws
/// InputError for anything that is not such a file, within bounded memory.
Image read_image(const std::string& path);

/// `passing`: the image will be replaced soon. It is packed less, in less time, and not synced.
enum class ImageLife { lasting, passing };

/// An 8-bit sRGB PNG of R, G, B times 2^exposure, written like write_exr. `view` names the view
/// transform: "filmic" has a toe and a shoulder, "srgb" clips above 1 (docs/reference/output.md).
/// Throws InputError for another view.
void write_png(const Image& image, const std::string& path, double exposure = 0,
               const std::string& view = "filmic", ImageLife life = ImageLife::lasting);

} // namespace vdbeam
