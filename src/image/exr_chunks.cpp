#include "image/exr_chunks.h"

#include "image/image_readers.h"
#include "vdbeam/error.h"

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfPartType.h>
#include <ImfTiledInputPart.h>
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>

namespace vdbeam {
namespace {

/// Bytes of pixels for one byte of the file, at most. Deflate packs 1032 to 1, and PXR24 leaves out
/// a quarter of a float before that; PIZ repeats a value of two bytes up to 255 times in ten bits;
/// DWA may leave out 63 of 64 coefficients before it deflates.
double most_per_byte(Imf::Compression compression) {
  switch (compression) {
  case Imf::NO_COMPRESSION:
    return 1;
  case Imf::RLE_COMPRESSION:
    return 64;
  case Imf::DWAA_COMPRESSION:
  case Imf::DWAB_COMPRESSION:
    return 64 * 1032;
  default:
    return 1376;
  }
}

std::int64_t bytes_per_pixel(const Imf::Header& header) {
  std::int64_t bytes = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
    bytes += it.channel().type == Imf::HALF ? 2 : 4;
  return bytes;
}

/// Size that the chunk inflates to, counted up to one byte more than `most`.
std::int64_t inflated_size(const char* chunk, int size, std::int64_t most) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK)
    throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(chunk)); // zlib only reads it
  stream.avail_in = static_cast<uInt>(size);
  std::array<Bytef, 1 << 16> piece;
  int status = Z_OK;
  while (status == Z_OK && static_cast<std::int64_t>(stream.total_out) <= most) {
    stream.next_out = piece.data();
    stream.avail_out = piece.size();
    status = inflate(&stream, Z_NO_FLUSH);
  }
  inflateEnd(&stream);
  return static_cast<std::int64_t>(stream.total_out);
}

/// Unpacked size of a chunk of OpenEXR's run-length code: a negative count n is followed by -n
/// bytes as they are, another by one byte that stands for n + 1.
std::int64_t unrolled_size(const char* chunk, int size) {
  std::int64_t bytes = 0;
  for (int i = 0; i < size;) {
    const int count = static_cast<signed char>(chunk[i]);
    bytes += count < 0 ? -count : count + 1;
    i += count < 0 ? 1 - count : 2;
  }
  return bytes;
}

/// Whether a chunk has all the pixels that it stands for. Other codecs than these check it.
bool is_whole(Imf::Compression compression, const char* chunk, int size, std::int64_t expected) {
  if (size == expected) // a chunk that compression would not make smaller is stored as it is
    return true;
  switch (compression) {
  case Imf::NO_COMPRESSION:
    return false;
  case Imf::RLE_COMPRESSION:
    return unrolled_size(chunk, size) == expected;
  case Imf::ZIPS_COMPRESSION:
  case Imf::ZIP_COMPRESSION:
    return inflated_size(chunk, size, expected) == expected;
  default:
    return true;
  }
}

int lines_per_chunk(Imf::Compression compression) {
  return compression == Imf::ZIP_COMPRESSION ? 16 : 1; // of those that is_whole unpacks
}

bool is_unpacked_here(Imf::Compression compression) {
  return compression == Imf::NO_COMPRESSION || compression == Imf::RLE_COMPRESSION ||
         compression == Imf::ZIPS_COMPRESSION || compression == Imf::ZIP_COMPRESSION;
}

bool lines_are_whole(Imf::InputPart& part) {
  const Imf::Header& header = part.header();
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t line =
      (std::int64_t{window.max.x} - window.min.x + 1) * bytes_per_pixel(header);
  const int lines = lines_per_chunk(header.compression());
  for (std::int64_t y = window.min.y; y <= window.max.y; y += lines) {
    const char* chunk = nullptr;
    int size = 0;
    part.rawPixelData(static_cast<int>(y), chunk, size);
    if (!is_whole(header.compression(), chunk, size,
                  line * std::min<std::int64_t>(lines, window.max.y - y + 1)))
      return false;
  }
  return true;
}

/// Only the finest level is ever read.
bool tiles_are_whole(Imf::TiledInputPart& part) {
  const Imf::Header& header = part.header();
  for (int row = 0; row < part.numYTiles(0); ++row)
    for (int column = 0; column < part.numXTiles(0); ++column) {
      const Imath::Box2i tile = part.dataWindowForTile(column, row, 0);
      int x = column, y = row, level_x = 0, level_y = 0, size = 0;
      const char* chunk = nullptr;
      part.rawTileData(x, y, level_x, level_y, chunk, size);
      const std::int64_t pixels =
          (std::int64_t{tile.max.x} - tile.min.x + 1) * (std::int64_t{tile.max.y} - tile.min.y + 1);
      if (!is_whole(header.compression(), chunk, size, pixels * bytes_per_pixel(header)))
        return false;
    }
  return true;
}

} // namespace

void check_part_fits_file(const Imf::Header& header, const std::string& path) {
  const Imath::Box2i window = header.dataWindow();
  const double pixels = (static_cast<double>(window.max.x) - window.min.x + 1) *
                        (static_cast<double>(window.max.y) - window.min.y + 1);
  check_size_fits_file(path, pixels * static_cast<double>(bytes_per_pixel(header)),
                       most_per_byte(header.compression()));
}

void check_chunks(Imf::MultiPartInputFile& file, int part, const std::string& path) {
  const Imf::Header& header = file.header(part);
  check_part_fits_file(header, path);
  if (!is_unpacked_here(header.compression()))
    return;
  bool whole = false;
  if (header.hasType() ? Imf::isTiled(header.type()) : header.hasTileDescription()) {
    Imf::TiledInputPart tiled(file, part);
    whole = tiles_are_whole(tiled);
  } else {
    Imf::InputPart lines(file, part);
    whole = lines_are_whole(lines);
  }
  if (!whole)
    throw InputError(path +
                     ": not a readable EXR: it holds fewer pixels than its header says; copy "
                     "or write it again");
}

} // namespace vdbeam
