#include "image/picture_guard.h"

#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "vdbeam/error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>

namespace vdbeam {
namespace {

using nlohmann::json;

/// Everything but the pixels.
json describe(const Image& image) {
  json description = {{"width", image.width},
                      {"height", image.height},
                      {"x", image.x},
                      {"y", image.y},
                      {"full_width", image.full_width},
                      {"full_height", image.full_height},
                      {"metadata", image.metadata},
                      {"numbers", image.numbers},
                      {"integers", image.integers},
                      {"matrices", image.matrices},
                      {"channels", json::array()}};
  if (const auto& p = image.primaries)
    description["primaries"] = {p->red_x,  p->red_y,  p->green_x, p->green_y,
                                p->blue_x, p->blue_y, p->white_x, p->white_y};
  for (const ImageChannel& channel : image.channels)
    description["channels"].push_back(
        {{"name", channel.name}, {"half", channel.half}, {"values", channel.data.size()}});
  return description;
}

/// The child's side: the length of the description, the description, then the channels' pixels.
void write_image_to(int descriptor, Image&& image) {
  const std::vector<std::uint8_t> description = json::to_cbor(describe(image));
  const std::uint64_t length = description.size();
  write_all(descriptor, &length, sizeof length);
  write_all(descriptor, description.data(), description.size());
  for (ImageChannel& channel : image.channels) {
    write_all(descriptor, channel.data.data(), channel.data.size() * sizeof(float));
    channel.data = {};
  }
}

/// Takes bytes off the front of what the child wrote, which a damaged file may have cut short.
class Answer {
public:
  explicit Answer(const MappedFile& file) : next_(file.data()), left_(file.size()) {}
  const std::byte* take(std::uint64_t bytes) {
    if (bytes > left_)
      throw std::runtime_error("the answer is too short");
    left_ -= static_cast<std::size_t>(bytes);
    return std::exchange(next_, next_ + bytes);
  }

private:
  const std::byte* next_;
  std::size_t left_;
};

Image parse_image(const MappedFile& file) {
  Answer answer(file);
  std::uint64_t length = 0;
  std::memcpy(&length, answer.take(sizeof length), sizeof length);
  const auto* first = reinterpret_cast<const std::uint8_t*>(answer.take(length));
  const json description = json::from_cbor(first, first + length);
  Image image;
  description.at("width").get_to(image.width);
  description.at("height").get_to(image.height);
  description.at("x").get_to(image.x);
  description.at("y").get_to(image.y);
  description.at("full_width").get_to(image.full_width);
  description.at("full_height").get_to(image.full_height);
  description.at("metadata").get_to(image.metadata);
  description.at("numbers").get_to(image.numbers);
  description.at("integers").get_to(image.integers);
  description.at("matrices").get_to(image.matrices);
  image.primaries.reset();
  if (const auto found = description.find("primaries"); found != description.end()) {
    const auto p = found->get<std::array<double, 8>>();
    image.primaries = {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]};
  }
  for (const json& each : description.at("channels")) {
    ImageChannel channel;
    each.at("name").get_to(channel.name);
    each.at("half").get_to(channel.half);
    const auto values = each.at("values").get<std::uint64_t>();
    const std::byte* pixels = answer.take(values * sizeof(float));
    channel.data.resize(static_cast<std::size_t>(values));
    std::memcpy(channel.data.data(), pixels, channel.data.size() * sizeof(float));
    image.channels.push_back(std::move(channel));
  }
  return image;
}

} // namespace

Image read_guarded_picture(const std::string& path, Image (*read)(const std::string& path)) {
  try {
    const std::uint64_t bytes = open_input_file(path).bytes;
    GuardLimits limits;
    limits.seconds += time_for(bytes);
    // A byte of the file may unpack to a thousand, and a slow decoder unpacks some 100 MB/s.
    limits.cpu_seconds = std::min(limits.seconds, 10 + 2e-5 * static_cast<double>(bytes));
    limits.bytes = free_memory();
    return parse_image(
        run_guarded(path, limits, [&](int output) { write_image_to(output, read(path)); }));
  } catch (const FrameError& error) { // for a picture, a damaged file is a wrong input
    throw InputError(error.what());
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {
    throw InputError(path + ": the image is damaged; copy or write it again");
  }
}

} // namespace vdbeam
