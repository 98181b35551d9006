#include "geometry/gltf/gltf_json.h"

#include "machine/input_file.h"
#include "text/text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace vdbeam {

/// The JSON of a binary glTF is its first chunk: 12 bytes of header, then its length and type.
std::string read_glb_text(const std::string& path) {
  InputStream file(path);
  unsigned char start[20];
  if (!file.read(reinterpret_cast<char*>(start), sizeof start))
    return {};
  std::uint32_t length = 0;
  for (int i = 3; i >= 0; --i)
    length = length << 8 | start[12 + i];
  constexpr std::uint32_t longest = 64u << 20;
  std::string text(std::min(length, longest), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

nlohmann::json read_gltf_json(const std::string& path) {
  if (lower_case(std::filesystem::path(path).extension().string()) == ".glb")
    return nlohmann::json::parse(read_glb_text(path), nullptr, false);
  InputStream file(path);
  return nlohmann::json::parse(file, nullptr, false);
}

std::uint64_t accessor_count(const nlohmann::json& gltf, const nlohmann::json& index) {
  return gltf.at("accessors").at(index.get<std::size_t>()).at("count").get<std::uint64_t>();
}

} // namespace vdbeam
