#include "image/exr_scanlines.h"

#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace vdbeam {
namespace {

/// A file in memory.
class MemoryStream : public Imf::OStream {
public:
  MemoryStream() : OStream("memory") {}
  void write(const char bytes[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (position_ + n > bytes_.size())
      bytes_.resize(position_ + n);
    std::memcpy(bytes_.data() + position_, bytes, n);
    position_ += n;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = static_cast<std::size_t>(position); }

  const std::vector<char>& bytes() const { return bytes_; }

private:
  std::vector<char> bytes_;
  std::size_t position_ = 0;
};

/// Rows that are packed together (OpenEXR's "File Layout").
int rows_per_chunk(Imf::Compression compression) {
  switch (compression) {
  case Imf::NO_COMPRESSION:
  case Imf::RLE_COMPRESSION:
  case Imf::ZIPS_COMPRESSION:
    return 1;
  case Imf::ZIP_COMPRESSION:
  case Imf::PXR24_COMPRESSION:
    return 16;
  case Imf::DWAB_COMPRESSION:
    return 256;
  default:
    return 32;
  }
}

std::size_t chunks_of(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const int rows = rows_per_chunk(header.compression());
  return static_cast<std::size_t>((window.max.y - window.min.y + rows) / rows);
}

/// What stands before the first chunk: the header, and the table of the chunks' places, empty.
std::vector<char> head_of(const Imf::Header& header) {
  MemoryStream stream;
  { const Imf::OutputFile file(stream, header, 0); }
  return stream.bytes();
}

/// The chunks of a band, one after the other.
std::vector<char> pack(const Imf::Header& whole, const Imath::Box2i& band,
                       const BandPixels& pixels) {
  Imf::Header header = whole;
  header.dataWindow() = band;
  const std::size_t begin = head_of(header).size();
  MemoryStream stream;
  BandHalves halves;
  Imf::OutputFile file(stream, header, 0);
  file.setFrameBuffer(pixels(band, halves));
  file.writePixels(band.max.y - band.min.y + 1);
  return {stream.bytes().begin() + static_cast<std::ptrdiff_t>(begin), stream.bytes().end()};
}

/// Appends chunks to the file, and their places to the table.
void append(const std::vector<char>& chunks, std::vector<std::uint64_t>& places, AtomicFile& file) {
  constexpr std::size_t head = 8; // the first row's number, and the size of what follows
  const std::uint64_t begin = file.position();
  for (std::size_t at = 0; at + head <= chunks.size();) {
    std::int32_t size = 0;
    std::memcpy(&size, chunks.data() + at + head / 2, sizeof size);
    places.push_back(begin + at);
    at += head + static_cast<std::size_t>(size);
  }
  file.write(chunks.data(), chunks.size());
}

std::vector<Imath::Box2i> bands_of(const Imf::Header& header) {
  constexpr int about = 32;
  const Imath::Box2i& window = header.dataWindow();
  const int rows = std::max(about, rows_per_chunk(header.compression()));
  std::vector<Imath::Box2i> bands;
  for (int y = window.min.y; y <= window.max.y; y += rows)
    bands.push_back({{window.min.x, y}, {window.max.x, std::min(y + rows - 1, window.max.y)}});
  return bands;
}

} // namespace

void write_scanlines(const Imf::Header& header, const BandPixels& pixels, AtomicFile& file) {
  const std::vector<char> head = head_of(header);
  const std::size_t chunks = chunks_of(header);
  file.write(head.data(), head.size());
  std::vector<std::uint64_t> places;
  const std::vector<Imath::Box2i> bands = bands_of(header);
  // The number of bands that are in memory at a time.
  const std::size_t at_once =
      2 * tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  std::vector<std::vector<char>> packed(std::min(at_once, bands.size()));
  for (std::size_t begin = 0; begin < bands.size(); begin += packed.size()) {
    const std::size_t count = std::min(packed.size(), bands.size() - begin);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { packed[i] = pack(header, bands[begin + i], pixels); });
    for (std::size_t i = 0; i < count; ++i)
      append(packed[i], places, file);
  }
  if (places.size() != chunks)
    throw std::runtime_error("it has another number of blocks of rows than expected");
  const std::uint64_t end = file.position();
  const std::size_t table = chunks * sizeof(std::uint64_t);
  file.seek(head.size() - table);
  file.write(places.data(), table);
  file.seek(end);
}

} // namespace vdbeam
