#include "image/plane_file.h"

#include "image/exr_chunks.h"
#include "image/exr_scanlines.h"
#include "image/exr_stream.h"
#include "vdbeam/error.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfMultiPartInputFile.h>

#include <bit>

namespace vdbeam {
namespace {

static_assert(std::endian::native == std::endian::little, "doubles are stored low half first");
constexpr int largest_side = 65536;

/// Calls visit(channel name, slice) for the channels of a plane that lies over `window`.
template <class Visit>
void visit_slices(const ImagePlane& plane, const Imath::Box2i& window, const Visit& visit) {
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  const auto slice = [&](Imf::PixelType type, const void* first, std::size_t stride) {
    return Imf::Slice::Make(type, first, window, stride, stride * width);
  };
  if (const auto* doubles = std::get_if<double*>(&plane.values)) {
    const char* first = reinterpret_cast<const char*>(*doubles);
    visit(plane.name + ".low", slice(Imf::UINT, first, 8 * plane.stride));
    visit(plane.name + ".high", slice(Imf::UINT, first + 4, 8 * plane.stride));
  } else if (const auto* floats = std::get_if<float*>(&plane.values)) {
    visit(plane.name, slice(Imf::FLOAT, *floats, 4 * plane.stride));
  } else {
    const auto* counts = std::get<std::uint32_t*>(plane.values);
    visit(plane.name, slice(Imf::UINT, counts, 4 * plane.stride));
  }
}

/// A picture's windows, or those of a part of one that begins at (0, 0).
bool are_windows(const Imath::Box2i& data, const Imath::Box2i& display) {
  // Overscan reaches beyond the display window.
  const auto within = [](const Imath::V2i& p) {
    return std::abs(p.x) < largest_side && std::abs(p.y) < largest_side;
  };
  return !data.isEmpty() && display.min == Imath::V2i(0, 0) && within(data.min) &&
         within(data.max) && within(display.max) && display.intersects(data);
}

void write_file(const Image& picture, const std::vector<ImagePlane>& planes, AtomicFile& file) {
  Imf::Header header = exr_header(picture, file.path());
  const Imath::Box2i window = header.dataWindow();
  Imf::FrameBuffer pixels;
  const auto add = [&](const std::string& name, const Imf::Slice& slice) {
    header.channels().insert(name, Imf::Channel(slice.type));
    pixels.insert(name, slice);
  };
  for (const ImageChannel& channel : picture.channels)
    add(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.data.data(), window));
  for (const ImagePlane& plane : planes)
    visit_slices(plane, window, add);
  write_scanlines(
      header, [&](const Imath::Box2i&, BandHalves&) { return pixels; }, file);
}

} // namespace

void write_planes(const Image& picture, const std::vector<ImagePlane>& planes,
                  const std::string& path, Links links) {
  AtomicFile file(path, links);
  with_exr<FrameError>(path, "cannot be written", [&] { write_file(picture, planes, file); });
  file.commit();
}

Image read_exr_header(const std::string& path) {
  return with_exr<InputError>(path, "not a readable EXR", [&] {
    check_attribute_sizes(path);
    const Imf::InputFile file(path.c_str());
    Image image;
    copy_attributes(file.header(), image);
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it)
      image.channels.push_back({it.name(), {}, it.channel().type == Imf::HALF});
    const Imath::Box2i data = file.header().dataWindow(), display = file.header().displayWindow();
    if (!are_windows(data, display))
      return image;
    check_part_fits_file(file.header(), path);
    image.x = data.min.x;
    image.y = data.min.y;
    image.width = data.max.x - data.min.x + 1;
    image.height = data.max.y - data.min.y + 1;
    image.full_width = display.max.x + 1;
    image.full_height = display.max.y + 1;
    return image;
  });
}

bool read_planes(const std::string& path, int width, int height,
                 const std::vector<ImagePlane>& planes) {
  return with_exr<InputError>(path, "not a readable EXR", [&] {
    check_attribute_sizes(path);
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    bool whole = file.isComplete() && are_windows(window, file.header().displayWindow()) &&
                 window.max.x - window.min.x + 1 == width &&
                 window.max.y - window.min.y + 1 == height;
    if (!whole)
      return false;
    Imf::FrameBuffer pixels;
    for (const ImagePlane& plane : planes)
      visit_slices(plane, window, [&](const std::string& name, const Imf::Slice& slice) {
        const Imf::Channel* channel = file.header().channels().findChannel(name);
        whole = whole && channel && channel->type == slice.type && channel->xSampling == 1 &&
                channel->ySampling == 1;
        pixels.insert(name, slice);
      });
    if (!whole)
      return false;
    Imf::MultiPartInputFile chunks(path.c_str(), 0);
    check_chunks(chunks, 0, path);
    file.setFrameBuffer(pixels);
    file.readPixels(window.min.y, window.max.y);
    return true;
  });
}

} // namespace vdbeam
