#pragma once

#include "machine/atomic_file.h"
#include "vdbeam/image.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace vdbeam {

/// Numbers of full precision, one per pixel: `values` is the first pixel's, `stride` numbers lie
/// between two pixels.
struct ImagePlane {
  std::string name;
  std::variant<double*, float*, std::uint32_t*> values;
  std::size_t stride;
};

/// Writes an EXR that is complete or not there: the picture's channels as float, and the planes bit
/// for bit, a double as two 32-bit integers NAME.low and NAME.high. Throws FrameError.
void write_planes(const Image& picture, const std::vector<ImagePlane>& planes,
                  const std::string& path, Links links = Links::follow);

/// Windows, attributes and the names of the channels, which hold no data. The size is 0 where the
/// windows are not those of a picture or of a part of one. Throws InputError.
Image read_exr_header(const std::string& path);

/// Fills the planes of a file of `width` x `height` pixels. False where the file is incomplete, of
/// another size or lacks one of them in its very type. Throws InputError.
bool read_planes(const std::string& path, int width, int height,
                 const std::vector<ImagePlane>& planes);

} // namespace vdbeam
