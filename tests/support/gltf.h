#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace vdbeam::test {

/// Floats as a data: URI; their number must be a multiple of three, so that the text ends with
/// them.
inline std::string data_uri(const std::vector<float>& values) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  std::string text = "data:application/octet-stream;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | static_cast<unsigned char>(bytes[i + k]);
    for (int shift = 18; shift >= 0; shift -= 6)
      text += digits[bits >> shift & 63];
  }
  return text;
}

/// A glTF with the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) on a node that grows to twice its size
/// in two seconds, below one that moves from x = 3 to 13 and turns by 90 degrees about z.
inline std::string moving_triangle(const std::string& interpolation) {
  constexpr float half = 0.70710678f;
  const std::vector<float> values{0, 0, 0, 1,  0, 0, 0,    1,    0, // 0: positions
                                  0, 2,                             // 36: times
                                  3, 0, 0, 13, 0, 0,                // 44: places
                                  0, 0, 0, 1,  0, 0, half, half,    // 68: rotations
                                  1, 1, 1, 2,  2, 2, 0,    0};      // 100: sizes
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
    "nodes": [{{"name": "arm", "translation": [3, 0, 0], "children": [1]}}, {{"name": "hand", "mesh": 0}}],
    "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
    "buffers": [{{"byteLength": 132, "uri": "{}"}}],
    "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 8}},
      {{"buffer": 0, "byteOffset": 44, "byteLength": 24}}, {{"buffer": 0, "byteOffset": 68, "byteLength": 32}},
      {{"buffer": 0, "byteOffset": 100, "byteLength": 24}}],
    "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "max": [1, 1, 0], "min": [0, 0, 0]}},
      {{"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "max": [2], "min": [0]}},
      {{"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}},
      {{"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC4"}},
      {{"bufferView": 4, "componentType": 5126, "count": 2, "type": "VEC3"}}],
    "animations": [{{"samplers": [{{"input": 1, "output": 2, "interpolation": "{}"}}, {{"input": 1, "output": 3}},
      {{"input": 1, "output": 4}}], "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "translation"}}}},
      {{"sampler": 1, "target": {{"node": 0, "path": "rotation"}}}}, {{"sampler": 2, "target": {{"node": 1, "path": "scale"}}}}]}}]}})",
      data_uri(values), interpolation);
}

} // namespace vdbeam::test
