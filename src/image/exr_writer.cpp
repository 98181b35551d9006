#include "image/exr_scanlines.h"
#include "image/exr_stream.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfFramesPerSecond.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputPart.h>
#include <ImfTimeCodeAttribute.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>
#include <half.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

namespace vdbeam {
namespace {

void check_image(const Image& image, const std::string& path) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  if (image.width <= 0 || image.height <= 0 || image.channels.empty())
    throw FrameError(fmt::format("{}: nothing to write: the image is {} x {} with {} channels",
                                 path, image.width, image.height, image.channels.size()));
  for (const ImageChannel& channel : image.channels)
    if (channel.data.size() != pixels)
      throw FrameError(fmt::format("{}: channel {} has {} values, the image {} pixels", path,
                                   channel.name, channel.data.size(), pixels));
}

/// Whether halves represent the values: over their range values would become infinite, and a
/// channel that is dark everywhere would lose its digits, at last all of them. Under the least
/// normal half digits get fewer; 16 times it leaves the brightest values all of theirs and values a
/// thousand times darker some.
bool fits_half(const ImageChannel& channel) {
  float largest = 0;
  for (const float value : channel.data)
    if (std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  return largest == 0 || (largest <= HALF_MAX && largest >= 16 * HALF_NRM_MIN);
}

Imf::Chromaticities exr_chromaticities(const Chromaticities& c) {
  const auto point = [](double x, double y) {
    return Imath::V2f(static_cast<float>(x), static_cast<float>(y));
  };
  return {point(c.red_x, c.red_y), point(c.green_x, c.green_y), point(c.blue_x, c.blue_y),
          point(c.white_x, c.white_y)};
}

/// Hours, minutes, seconds and frames, as "01:02:03:04"; any other text is left out.
void add_time_code(Imf::Header& header, const std::string& text) {
  int part[4] = {};
  char end = 0;
  if (std::sscanf(text.c_str(), "%2d:%2d:%2d:%2d%c", &part[0], &part[1], &part[2], &part[3],
                  &end) == 4)
    Imf::addTimeCode(header, Imf::TimeCode(part[0], part[1], part[2], part[3]));
}

} // namespace

Imf::Header exr_header(const Image& image, const std::string& path) {
  const Imath::Box2i data({image.x, image.y},
                          {image.x + image.width - 1, image.y + image.height - 1});
  const Imath::Box2i display =
      image.full_width > 0 ? Imath::Box2i({0, 0}, {image.full_width - 1, image.full_height - 1})
                           : data;
  Imf::Header header(display, data);
  header.compression() = Imf::ZIP_COMPRESSION;
  if (image.primaries)
    Imf::addChromaticities(header, exr_chromaticities(*image.primaries));
  for (const auto& [name, text] : image.metadata) {
    if (name == "timeCode")
      add_time_code(header, text);
    else
      header.insert(name, Imf::StringAttribute(text));
  }
  for (const auto& [name, value] : image.numbers) {
    if (name == "framesPerSecond") // standard attributes with types of their own
      Imf::addFramesPerSecond(header, Imf::guessExactFps(value));
    else if (name == "utcOffset")
      Imf::addUtcOffset(header, static_cast<float>(value));
    else if (image.integers.contains(name) && std::abs(value) <= std::numeric_limits<int>::max())
      header.insert(name, Imf::IntAttribute(static_cast<int>(value)));
    else
      header.insert(name, Imf::DoubleAttribute(value));
  }
  for (const auto& [name, values] : image.matrices) {
    if (values.size() == 3) {
      header.insert(name, Imf::V3fAttribute({values[0], values[1], values[2]}));
      continue;
    }
    if (values.size() != 16)
      throw FrameError(
          fmt::format("{}: matrix {} has {} values instead of 16", path, name, values.size()));
    Imath::M44f matrix;
    for (int i = 0; i < 16; ++i)
      matrix[i / 4][i % 4] = values[static_cast<std::size_t>(i)];
    header.insert(name, Imf::M44fAttribute(matrix));
  }
  return header;
}

namespace {

/// A channel as the file stores it.
struct StoredChannel {
  const ImageChannel* source = nullptr;
  bool half = false;
};

/// Where the file finds the rows of a channel in a band, a part of the whole window. `halves` holds
/// them, if the file holds halves.
Imf::Slice make_slice(const StoredChannel& channel, const Imath::Box2i& whole,
                      const Imath::Box2i& band, std::vector<Imath::half>& halves) {
  const auto width = static_cast<std::size_t>(whole.max.x - whole.min.x + 1);
  const auto rows = static_cast<std::size_t>(band.max.y - band.min.y + 1);
  const float* values =
      channel.source->data.data() + static_cast<std::size_t>(band.min.y - whole.min.y) * width;
  // OpenEXR only reads from the slices of an output file, yet asks for char*.
  if (!channel.half)
    return Imf::Slice::Make(Imf::FLOAT, values, band, sizeof(float), sizeof(float) * width);
  halves.resize(rows * width);
  std::transform(values, values + halves.size(), halves.begin(),
                 [](float value) { return Imath::half(value); });
  return Imf::Slice::Make(Imf::HALF, halves.data(), band, sizeof(Imath::half),
                          sizeof(Imath::half) * width);
}

Imf::Compression compression_named(const std::string& asked) {
  const std::pair<const char*, Imf::Compression> names[] = {
      {"zips", Imf::ZIPS_COMPRESSION}, {"piz", Imf::PIZ_COMPRESSION},
      {"rle", Imf::RLE_COMPRESSION},   {"none", Imf::NO_COMPRESSION},
      {"dwaa", Imf::DWAA_COMPRESSION}, {"dwab", Imf::DWAB_COMPRESSION}};
  for (const auto& [name, compression] : names)
    if (asked == name)
      return compression;
  return Imf::ZIP_COMPRESSION;
}

/// A setting of the scene that is stored as an attribute; empty if absent.
std::string wish(const Image& image, const char* attribute) {
  const auto found = image.metadata.find(attribute);
  return found == image.metadata.end() ? std::string() : found->second;
}

/// A part of the file: a layer, or all of them.
struct Part {
  std::string name;
  std::vector<StoredChannel> channels;
};

/// R, G, B and A are the part "rgba"; what stands in no layer belongs to it too.
std::vector<Part> split_in_parts(const Image& image) {
  const bool by_layer = wish(image, "vdbeam:parts") == "layers";
  std::vector<Part> parts{{"rgba", {}}};
  for (const ImageChannel& channel : image.channels) {
    const auto dot = channel.name.rfind('.');
    const std::string layer =
        by_layer && dot != std::string::npos ? channel.name.substr(0, dot) : parts[0].name;
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const Part& known) { return known.name == layer; });
    if (part == parts.end())
      part = parts.insert(parts.end(), {layer, {}});
    part->channels.push_back({&channel});
  }
  std::erase_if(parts, [](const Part& part) { return part.channels.empty(); });
  return parts;
}

/// The compression of a layer's part, from "layer:compression layer:compression ...".
Imf::Compression compression_of(const Image& image, const std::string& part) {
  std::istringstream pairs(wish(image, "vdbeam:partCompression"));
  for (std::string pair; pairs >> pair;)
    if (const auto colon = pair.rfind(':'); pair.substr(0, colon) == part)
      return compression_named(pair.substr(colon + 1));
  return compression_named(wish(image, "vdbeam:compression"));
}

/// Width of the tiles that the scene asks for; 0: it wants scan lines.
unsigned tile_width_of(const Image& image) {
  const auto found = image.numbers.find("vdbeam:tile");
  return found == image.numbers.end() ? 0 : static_cast<unsigned>(found->second);
}

/// Where the file finds the channels of a band.
Imf::FrameBuffer band_pixels(const Part& part, const Imath::Box2i& whole, const Imath::Box2i& band,
                             BandHalves& halves) {
  halves.resize(part.channels.size());
  Imf::FrameBuffer pixels;
  for (std::size_t i = 0; i < part.channels.size(); ++i)
    pixels.insert(part.channels[i].source->name,
                  make_slice(part.channels[i], whole, band, halves[i]));
  return pixels;
}

Imf::Header header_of(const Image& image, Part& part, bool one_of_several,
                      const std::string& path) {
  Imf::Header header = exr_header(image, path);
  header.compression() = compression_of(image, part.name);
  tbb::parallel_for(std::size_t{0}, part.channels.size(), [&](std::size_t i) {
    StoredChannel& channel = part.channels[i];
    channel.half = channel.source->half && fits_half(*channel.source);
  });
  for (const StoredChannel& channel : part.channels)
    header.channels().insert(channel.source->name,
                             Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
  const unsigned tile = tile_width_of(image);
  if (tile > 0)
    header.setTileDescription(Imf::TileDescription(tile, tile, Imf::ONE_LEVEL));
  if (one_of_several)
    header.setName(part.name);
  if (one_of_several || tile > 0)
    header.setType(tile > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  return header;
}

/// A file of several parts, or of tiles.
void write_parts(const Image& image, const std::vector<Part>& parts,
                 const std::vector<Imf::Header>& headers, AtomicFile& file) {
  AtomicStream stream(file);
  Imf::MultiPartOutputFile output(stream, headers.data(), static_cast<int>(headers.size()), false,
                                  0);
  const Imath::Box2i whole = headers[0].dataWindow();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    BandHalves halves;
    const Imf::FrameBuffer pixels = band_pixels(parts[i], whole, whole, halves);
    if (tile_width_of(image) > 0) {
      Imf::TiledOutputPart part(output, static_cast<int>(i));
      part.setFrameBuffer(pixels);
      part.writeTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
    } else {
      Imf::OutputPart part(output, static_cast<int>(i));
      part.setFrameBuffer(pixels);
      part.writePixels(image.height);
    }
  }
}

void write_channels(const Image& image, AtomicFile& file) {
  std::vector<Part> parts = split_in_parts(image);
  std::vector<Imf::Header> headers;
  for (Part& part : parts)
    headers.push_back(header_of(image, part, parts.size() > 1, file.path()));
  if (parts.size() > 1 || tile_width_of(image) > 0)
    return write_parts(image, parts, headers, file);
  const Imath::Box2i whole = headers[0].dataWindow();
  write_scanlines(
      headers[0],
      [&](const Imath::Box2i& band, BandHalves& halves) {
        return band_pixels(parts[0], whole, band, halves);
      },
      file);
}

} // namespace

void write_exr(const Image& image, const std::string& path) {
  write_exr(image, path, Links::follow);
}

void write_exr(const Image& image, const std::string& path, Links links, Synced synced) {
  check_image(image, path);
  AtomicFile file(path, links);
  with_exr<FrameError>(path, "cannot be written", [&] { write_channels(image, file); });
  file.commit(synced);
}

} // namespace vdbeam
