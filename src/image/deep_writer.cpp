#include "image/exr_stream.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <half.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace vdbeam {
namespace {

/// Rows whose samples are handed over at once.
constexpr int rows_at_once = 64;

bool fits_half(const std::vector<float>& values) {
  float largest = 0;
  for (const float value : values)
    largest = std::max(largest, std::isfinite(value) ? std::abs(value) : 0.0f);
  return largest == 0 || (largest <= HALF_MAX && largest >= 16 * HALF_NRM_MIN);
}

/// One channel, with a pointer to each pixel's samples as OpenEXR asks for them.
class DeepChannel {
public:
  DeepChannel(const char* name, const std::vector<float>& values, bool half_asked)
      : name_(name), values_(values), half_(half_asked && fits_half(values)) {
    if (half_)
      halves_.assign(values.begin(), values.end());
  }

  const char* name() const { return name_; }
  Imf::PixelType type() const { return half_ ? Imf::HALF : Imf::FLOAT; }
  std::size_t size() const { return half_ ? sizeof(half) : sizeof(float); }
  const char* sample(std::size_t i) const {
    return half_ ? reinterpret_cast<const char*>(halves_.data() + i)
                 : reinterpret_cast<const char*>(values_.data() + i);
  }

private:
  const char* name_;
  const std::vector<float>& values_;
  bool half_;
  std::vector<half> halves_;
};

void write_rows(const DeepImage& deep, const std::array<DeepChannel, 6>& channels,
                const Imath::Box2i& window, Imf::DeepScanLineOutputFile& output) {
  const auto width = static_cast<std::size_t>(deep.width);
  std::array<std::vector<const char*>, 6> pointers;
  std::size_t sample = 0;
  for (int row = 0; row < deep.height; row += rows_at_once) {
    const int rows = std::min(rows_at_once, deep.height - row);
    const std::size_t first = static_cast<std::size_t>(row) * width;
    const std::size_t count = static_cast<std::size_t>(rows) * width;
    for (std::vector<const char*>& list : pointers)
      list.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < channels.size(); ++c)
        pointers[c][i] = channels[c].sample(sample);
      sample += deep.counts[first + i];
    }
    // OpenEXR addresses pixel (0, 0) of the picture, wherever the data begin.
    const std::ptrdiff_t shift =
        static_cast<std::ptrdiff_t>(window.min.y + row) * deep.width + window.min.x;
    const auto base = [&](const void* data, std::size_t size) {
      return const_cast<char*>(static_cast<const char*>(data)) -
             shift * static_cast<std::ptrdiff_t>(size);
    };
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT,
                                            base(deep.counts.data() + first, sizeof(std::uint32_t)),
                                            sizeof(std::uint32_t), sizeof(std::uint32_t) * width));
    for (std::size_t c = 0; c < channels.size(); ++c)
      frame.insert(channels[c].name(),
                   Imf::DeepSlice(channels[c].type(), base(pointers[c].data(), sizeof(char*)),
                                  sizeof(char*), sizeof(char*) * width, channels[c].size()));
    output.setFrameBuffer(frame);
    output.writePixels(rows);
  }
}

} // namespace

std::uint64_t write_deep_exr(const DeepImage& deep, const Image& attributes,
                             const std::string& path) {
  AtomicFile file(path);
  with_exr<FrameError>(path, "cannot be written", [&] {
    Image frame = attributes;
    frame.width = deep.width;
    frame.height = deep.height;
    Imf::Header header = exr_header(frame, path);
    header.compression() = Imf::ZIPS_COMPRESSION; // one of the few that deep files may have
    header.setType(Imf::DEEPSCANLINE);
    const std::array<DeepChannel, 6> channels{
        DeepChannel("R", deep.r, true),  DeepChannel("G", deep.g, true),
        DeepChannel("B", deep.b, true),  DeepChannel("A", deep.a, false),
        DeepChannel("Z", deep.z, false), DeepChannel("ZBack", deep.z_back, false)};
    for (const DeepChannel& channel : channels)
      header.channels().insert(channel.name(), Imf::Channel(channel.type()));
    AtomicStream stream(file);
    Imf::DeepScanLineOutputFile output(stream, header);
    write_rows(deep, channels, header.dataWindow(), output);
  });
  file.commit();
  std::error_code error; // a size is nothing to lose a picture for
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  return error ? 0 : bytes;
}

} // namespace vdbeam
