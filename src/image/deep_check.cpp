#include "image/deep_check.h"

#include "image/exr_stream.h"
#include "image/image_readers.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputFile.h>

#include <cstdint>
#include <vector>

namespace vdbeam {

void check_deep_exr(const std::string& path) {
  with_exr<InputError>(path, "not a readable deep EXR", [&] {
    check_attribute_sizes(path);
    Imf::DeepScanLineInputFile file(path.c_str(), 0);
    if (!file.isComplete())
      throw InputError(path + ": the deep EXR is incomplete; its writer was interrupted");
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    if (width > max_image_side)
      throw InputError(path + ": the deep EXR is too wide");
    std::vector<std::uint32_t> counts(static_cast<std::size_t>(width));
    // One row in memory: its pixels take the place of those of each row.
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT,
                                            reinterpret_cast<char*>(counts.data() - window.min.x),
                                            sizeof(std::uint32_t), 0));
    file.setFrameBuffer(frame);
    file.readPixelSampleCounts(window.min.y, window.max.y);
  });
}

} // namespace vdbeam
