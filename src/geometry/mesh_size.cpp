#include "geometry/mesh_size.h"

#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace vdbeam {
namespace {

/// Of a header or a quick look; more vertices or triangles than anyone has are no more believed.
constexpr GuardLimits limits{.seconds = 20, .cpu_seconds = 20, .bytes = std::uint64_t(1) << 30};
constexpr std::uint64_t most = std::uint64_t(1) << 36;

/// Polygons of a PLY are taken for triangles.
MeshSize foretell_ply(std::istream& file) {
  MeshSize size;
  std::string line;
  for (int i = 0; i < 1000 && std::getline(file, line) && line.rfind("end_header", 0) != 0; ++i) {
    std::istringstream words(line);
    std::string element, name;
    std::uint64_t count = 0;
    if (!(words >> element >> name >> count) || element != "element")
      continue;
    if (name == "vertex")
      size.vertices = count;
    else if (name == "face")
      size.triangles = count;
  }
  return size;
}

/// A face of n corners is n - 2 triangles.
MeshSize foretell_obj(std::istream& file) {
  MeshSize size;
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("v ", 0) == 0)
      ++size.vertices;
    if (line.rfind("f ", 0) != 0)
      continue;
    std::uint64_t corners = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
      corners += line[i - 1] == ' ' && !std::isspace(static_cast<unsigned char>(line[i]));
    size.triangles += corners > 2 ? corners - 2 : 0;
  }
  return size;
}

std::uint64_t accessor_count(const nlohmann::json& gltf, const nlohmann::json& index) {
  return gltf.at("accessors").at(index.get<std::size_t>()).at("count").get<std::uint64_t>();
}

MeshSize foretell_gltf(const nlohmann::json& gltf) {
  MeshSize size;
  for (const auto& node : gltf.at("nodes")) {
    if (!node.contains("mesh"))
      continue;
    const auto& mesh = gltf.at("meshes").at(node.at("mesh").get<std::size_t>());
    for (const auto& primitive : mesh.at("primitives")) {
      const std::uint64_t vertices =
          accessor_count(gltf, primitive.at("attributes").at("POSITION"));
      size.vertices += vertices;
      size.triangles +=
          (primitive.contains("indices") ? accessor_count(gltf, primitive.at("indices"))
                                         : vertices) /
          3;
    }
  }
  return size;
}

/// The JSON of a binary glTF is its first chunk: 12 bytes of header, then its length and type.
std::string json_of_glb(std::istream& file) {
  unsigned char start[20];
  if (!file.read(reinterpret_cast<char*>(start), sizeof start))
    return {};
  std::uint32_t length = 0;
  for (int i = 3; i >= 0; --i)
    length = length << 8 | start[12 + i];
  constexpr std::uint32_t longest = 64u << 20;
  std::string text(std::min(length, longest), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  return text;
}

MeshSize foretell(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  std::ifstream file(path, std::ios::binary);
  if (extension == ".ply")
    return foretell_ply(file);
  if (extension == ".obj")
    return foretell_obj(file);
  const nlohmann::json gltf = extension == ".glb"
                                  ? nlohmann::json::parse(json_of_glb(file), nullptr, false)
                                  : nlohmann::json::parse(file, nullptr, false);
  try {
    return foretell_gltf(gltf);
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

} // namespace

MeshSize foretell_mesh(const std::string& path) {
  MeshSize size;
  try {
    open_input_file(path); // a pipe would never end
    const MappedFile answer = run_guarded(path, limits, [&](int output) {
      const MeshSize found = foretell(path);
      write_all(output, &found, sizeof found);
    });
    if (answer.size() == sizeof size)
      std::memcpy(&size, answer.data(), sizeof size);
  } catch (const Error&) {
  }
  return {std::min(size.vertices, most), std::min(size.triangles, most)};
}

} // namespace vdbeam
