#include "console/display_packets.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace vdbeam::cli {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr char create_image = 4, update_image = 6;
constexpr char keep_focus = 0; // the viewer goes on showing what it shows

class Packet {
public:
  explicit Packet(char kind) {
    add(std::uint32_t{0});
    bytes_ += kind;
    bytes_ += keep_focus;
  }
  template <class T>
  void add(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add_text(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void add_floats(const std::vector<float>& values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), sizeof(float) * values.size());
  }
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }
  std::string take() {
    const auto size = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &size, sizeof size);
    return std::move(bytes_);
  }

private:
  std::string bytes_;
};

} // namespace

std::string create_packet(const std::string& name, const Image& image) {
  Packet packet(create_image);
  packet.add_text(name);
  packet.add(std::int32_t{image.width});
  packet.add(std::int32_t{image.height});
  packet.add(static_cast<std::int32_t>(image.channels.size()));
  for (const ImageChannel& channel : image.channels)
    packet.add_text(channel.name);
  return packet.take();
}

std::string update_packet(const std::string& name, const Image& image,
                          const ImageChannel& channel) {
  constexpr std::int32_t one_channel = 1;
  constexpr std::int64_t offset = 0, stride = 1; // in floats
  Packet packet(update_image);
  packet.add_text(name);
  packet.add(one_channel);
  packet.add_text(channel.name);
  for (const std::int32_t number : {0, 0, image.width, image.height})
    packet.add(number);
  packet.add(offset);
  packet.add(stride);
  packet.reserve(sizeof(float) * channel.data.size());
  packet.add_floats(channel.data);
  return packet.take();
}

} // namespace vdbeam::cli
