#pragma once

#include "machine/atomic_file.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <half.h>

#include <functional>
#include <vector>

namespace vdbeam {

/// Halves that a frame buffer refers to, for one band of rows.
using BandHalves = std::vector<std::vector<Imath::half>>;

/// Where OpenEXR finds the pixels of a band, which is a part of the data window. `halves` may keep
/// what is made for it.
using BandPixels = std::function<Imf::FrameBuffer(const Imath::Box2i& band, BandHalves& halves)>;

/// Writes an EXR of one part in scan lines, to the bit the file that OpenEXR writes by itself, but
/// with all threads: OpenEXR has threads of its own, which would come on top of oneTBB's, while
/// whoever writes waits for them. Bands of rows are packed as pictures of their own and put
/// together. `pixels` is called by several threads at a time.
void write_scanlines(const Imf::Header& header, const BandPixels& pixels, AtomicFile& file);

} // namespace vdbeam
