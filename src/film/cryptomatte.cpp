#include "film/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace vdbeam {
namespace {

constexpr const char* layer_name = "CryptoObject";

std::uint32_t id_bits(std::string_view name) {
  const std::uint32_t hash = murmur_hash(name);
  const std::uint32_t exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ (1u << 23) : hash;
}

/// A name between quotes, as JSON has it.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\')
      text += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      text += c;
  }
  return text + "\"";
}

} // namespace

std::uint32_t murmur_hash(std::string_view text) {
  const auto mixed = [](std::uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; };
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  std::uint32_t hash = 0;
  std::size_t i = 0;
  for (; i + 4 <= text.size(); i += 4) {
    hash ^= mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t tail = 0;
  for (std::size_t j = text.size(); j > i; --j)
    tail = tail << 8 | byte(j - 1);
  hash ^= mixed(tail);
  hash ^= static_cast<std::uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

float object_id(std::string_view name) {
  return std::bit_cast<float>(id_bits(name));
}

CryptomatteWriter::CryptomatteWriter(const std::vector<std::string>& names, Image& image)
    : image_(image), first_(image.channels.size()) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  for (int layer = 0; layer < ranks / 2; ++layer)
    for (const char channel : {'R', 'G', 'B', 'A'})
      image.channels.push_back({fmt::format("{}{:02}.{}", layer_name, layer, channel),
                                std::vector<float>(pixels), false});
  std::string manifest;
  for (const std::string& name : names) {
    ids_.push_back(object_id(name));
    manifest +=
        fmt::format("{}{}:\"{:08x}\"", manifest.empty() ? "" : ",", quoted(name), id_bits(name));
  }
  order_.resize(names.size());
  const std::string key =
      "cryptomatte/" + fmt::format("{:08x}", murmur_hash(layer_name)).substr(0, 7);
  image.metadata[key + "/name"] = layer_name;
  image.metadata[key + "/hash"] = "MurmurHash3_32";
  image.metadata[key + "/conversion"] = "uint32_to_float32";
  image.metadata[key + "/manifest"] = "{" + manifest + "}";
}

void CryptomatteWriter::set(std::size_t pixel, const std::vector<float>& coverage) {
  for (std::size_t i = 0; i < order_.size(); ++i)
    order_[i] = i;
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return coverage[a] > coverage[b]; });
  for (std::size_t rank = 0; rank < ranks && rank < order_.size(); ++rank) {
    const std::size_t object = order_[rank];
    if (!(coverage[object] > 0))
      return;
    image_.channels[first_ + 2 * rank].data[pixel] = ids_[object];
    image_.channels[first_ + 2 * rank + 1].data[pixel] = coverage[object];
  }
}

} // namespace vdbeam
