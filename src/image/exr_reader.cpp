#include "image/exr_chunks.h"
#include "image/exr_stream.h"
#include "image/image_readers.h"
#include "image/layer_names.h"
#include "machine/input_file.h"
#include "vdbeam/error.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRationalAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTimeCodeAttribute.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace vdbeam {

void check_attribute_sizes(const std::string& path) {
  InputStream file(path, EmptyFile::accepted);
  file.seekg(8);              // magic number and version
  std::array<char, 257> text; // a name of the format has at most 255 bytes
  const auto read_name = [&] { return bool(file.getline(text.data(), text.size(), '\0')); };
  while (read_name() && text[0] != '\0') {
    std::uint32_t size = 0;
    read_name();
    file.read(reinterpret_cast<char*>(&size), sizeof size);
    if (!file || size > file.bytes())
      throw InputError(path + ": not a readable EXR: its header is damaged");
    file.seekg(size, std::ios::cur);
  }
}

void copy_attributes(const Imf::Header& header, Image& image) {
  if (Imf::hasChromaticities(header)) {
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    const auto number = [](float x) { return static_cast<double>(x); };
    image.primaries = {number(c.red.x),  number(c.red.y),  number(c.green.x), number(c.green.y),
                       number(c.blue.x), number(c.blue.y), number(c.white.x), number(c.white.y)};
  }
  for (auto it = header.begin(); it != header.end(); ++it) {
    const Imf::Attribute& attribute = it.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
      image.metadata[it.name()] = text->value();
    else if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
      image.numbers[it.name()] = real->value();
    else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
      image.numbers[it.name()] = single->value();
    else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
      image.numbers[it.name()] = integer->value();
      image.integers.insert(it.name());
    } else if (const auto* code = dynamic_cast<const Imf::TimeCodeAttribute*>(&attribute))
      image.metadata[it.name()] =
          fmt::format("{:02}:{:02}:{:02}:{:02}", code->value().hours(), code->value().minutes(),
                      code->value().seconds(), code->value().frame());
    else if (const auto* point = dynamic_cast<const Imf::V3fAttribute*>(&attribute))
      image.matrices[it.name()].assign(point->value().getValue(), point->value().getValue() + 3);
    else if (const auto* ratio = dynamic_cast<const Imf::RationalAttribute*>(&attribute))
      image.numbers[it.name()] = ratio->value();
    else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute))
      image.matrices[it.name()].assign(matrix->value().getValue(), matrix->value().getValue() + 16);
  }
}

namespace {

using Box = Imath::Box2i;

std::int64_t box_width(const Box& box) {
  return std::int64_t{box.max.x} - box.min.x + 1;
}
std::int64_t box_height(const Box& box) {
  return std::int64_t{box.max.y} - box.min.y + 1;
}

void check_size(const Box& box, std::size_t channels, const char* window, const std::string& path) {
  if (box.isEmpty())
    throw InputError(fmt::format("{}: its {} window is empty", path, window));
  const std::int64_t width = box_width(box), height = box_height(box);
  if (width > max_image_side || height > max_image_side || width * height > max_image_pixels ||
      width * height * static_cast<std::int64_t>(channels) > max_image_values)
    throw InputError(
        fmt::format("{}: its {} window of {} x {} pixels with {} channels is too large; "
                    "at most 2^28 pixels and 2^30 values are read",
                    path, window, width, height, channels));
}

std::vector<std::string> channel_names(const Imf::Header& header, const std::string& path) {
  std::vector<std::string> names;
  const Imf::ChannelList& list = header.channels();
  for (auto it = list.begin(); it != list.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw InputError(fmt::format("{}: channel {} is subsampled; convert the file to plain RGB",
                                   path, it.name()));
    names.emplace_back(it.name());
  }
  if (names.empty())
    throw InputError(path + ": the EXR has no channels");
  return names;
}

/// Reads the data window of each channel, row-major.
std::vector<std::vector<float>> read_pixels(Imf::InputPart& part,
                                            const std::vector<std::string>& names) {
  const Box data = part.header().dataWindow();
  const auto width = static_cast<std::size_t>(box_width(data));
  const auto height = static_cast<std::size_t>(box_height(data));
  std::vector<std::vector<float>> planes(names.size());
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < names.size(); ++i) {
    planes[i].resize(width * height);
    buffer.insert(names[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), data, sizeof(float),
                                             sizeof(float) * width));
  }
  part.setFrameBuffer(buffer);
  part.readPixels(data.min.y, data.max.y);
  return planes;
}

/// Cuts or pads the plane over the data window to the display window; 0 outside.
std::vector<float> place(std::vector<float>&& plane, const Box& data, const Box& display) {
  if (data == display)
    return std::move(plane);
  std::vector<float> placed(static_cast<std::size_t>(box_width(display) * box_height(display)));
  const int x0 = std::max(data.min.x, display.min.x), x1 = std::min(data.max.x, display.max.x);
  const int y0 = std::max(data.min.y, display.min.y), y1 = std::min(data.max.y, display.max.y);
  for (int y = y0; x0 <= x1 && y <= y1; ++y) {
    const std::int64_t from = (std::int64_t{y} - data.min.y) * box_width(data) + x0 - data.min.x;
    const std::int64_t to =
        (std::int64_t{y} - display.min.y) * box_width(display) + x0 - display.min.x;
    std::copy_n(plane.begin() + from, std::int64_t{x1} - x0 + 1, placed.begin() + to);
  }
  return placed;
}

/// Adds the channels of a part, which lies in the image's display window.
void read_part(Imf::MultiPartInputFile& file, int number, const std::string& path, Image& image) {
  const Imf::Header& header = file.header(number);
  const Box data = header.dataWindow(), display = header.displayWindow();
  const std::vector<std::string> names = channel_names(header, path);
  const std::size_t channels = image.channels.size() + names.size();
  check_size(data, channels, "data", path);
  check_size(display, channels, "display", path);
  if (!file.partComplete(number))
    throw InputError(path + ": the EXR is incomplete; its writer was interrupted");
  check_chunks(file, number, path);
  Imf::InputPart part(file, number);
  std::vector<std::vector<float>> planes = read_pixels(part, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_half = header.channels()[names[i].c_str()].type == Imf::HALF;
    image.channels.push_back({names[i], place(std::move(planes[i]), data, display), is_half});
  }
}

/// The first part, and others with layers of the same picture.
Image read_parts(Imf::MultiPartInputFile& file, const std::string& path) {
  const Imf::Header& header = file.header(0);
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw InputError(path + ": is a deep EXR; flatten it first");
  const Box display = header.displayWindow();
  check_size(display, 1, "display", path);

  Image image;
  image.width = static_cast<int>(box_width(display));
  image.height = static_cast<int>(box_height(display));
  copy_attributes(header, image);
  read_part(file, 0, path, image);
  for (int i = 1; i < file.parts(); ++i) {
    const Imf::Header& other = file.header(i);
    const bool deep = other.hasType() && Imf::isDeepData(other.type());
    if (!deep && other.displayWindow() == display && !image.find(other.channels().begin().name()))
      read_part(file, i, path, image);
  }
  return image;
}

/// A luminance image is also grey R, G, B.
void add_grey(Image& image) {
  const ImageChannel* luminance = image.find("Y");
  if (!luminance || image.find("R") || image.find("G") || image.find("B"))
    return;
  const ImageChannel grey = *luminance;
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, grey.data, grey.half});
}

} // namespace

Image read_exr(const std::string& path) {
  return with_exr<InputError>(path, "not a readable EXR", [&] {
    check_attribute_sizes(path);
    Imf::MultiPartInputFile file(path.c_str(), 0);
    Image image = read_parts(file, path);
    name_combined_rgba(image);
    add_grey(image);
    return image;
  });
}

std::string exr_library_version() {
  return OPENEXR_VERSION_STRING;
}

} // namespace vdbeam
