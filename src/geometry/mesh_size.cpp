#include "geometry/mesh_size.h"

#include "geometry/gltf/gltf_json.h"
#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace vdbeam {
namespace {

/// Limits of reading a header or scanning a file; counts above 2^36 are rejected.
constexpr GuardLimits limits{.seconds = 20, .cpu_seconds = 20, .bytes = std::uint64_t(1) << 30};
constexpr std::uint64_t most = std::uint64_t(1) << 36;

/// Polygons of a PLY are taken for triangles.
MeshSize foretell_ply(std::istream& file) {
  MeshSize size;
  std::string line;
  for (int i = 0; i < 1000 && std::getline(file, line) && line.rfind("end_header", 0) != 0; ++i) {
    std::istringstream words(line);
    std::string kind, name, rest;
    words >> kind >> name >> rest;
    size.normals = size.normals || (kind == "property" && rest == "nx");
    std::uint64_t count = 0;
    if (kind != "element" || !(std::istringstream(rest) >> count))
      continue;
    if (name == "vertex")
      size.vertices = count;
    else if (name == "face")
      size.triangles = count;
  }
  return size;
}

/// A face of n corners is n - 2 triangles. A vertex with k normals becomes k vertices.
MeshSize foretell_obj(std::istream& file) {
  MeshSize size;
  std::uint64_t normals = 0;
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("v ", 0) == 0)
      ++size.vertices;
    normals += line.rfind("vn ", 0) == 0;
    if (line.rfind("f ", 0) != 0)
      continue;
    std::uint64_t corners = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
      corners += line[i - 1] == ' ' && !std::isspace(static_cast<unsigned char>(line[i]));
    size.triangles += corners > 2 ? corners - 2 : 0;
  }
  size.normals = normals > 0;
  size.vertices = std::max(size.vertices, normals);
  return size;
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
      size.normals = size.normals || primitive.at("attributes").contains("NORMAL");
      size.triangles +=
          (primitive.contains("indices") ? accessor_count(gltf, primitive.at("indices"))
                                         : vertices) /
          3;
    }
  }
  return size;
}

MeshSize foretell(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  InputStream file(path);
  if (extension == ".ply")
    return foretell_ply(file);
  if (extension == ".obj")
    return foretell_obj(file);
  try {
    return foretell_gltf(read_gltf_json(path));
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

} // namespace

MeshSize foretell_mesh(const std::string& path) {
  MeshSize size;
  try {
    check_input_file(path);
    const MappedFile answer = run_guarded(path, limits, [&](int output) {
      const MeshSize found = foretell(path);
      write_all(output, &found, sizeof found);
    });
    if (answer.size() == sizeof size)
      std::memcpy(&size, answer.data(), sizeof size);
  } catch (const Error&) {
  }
  return {std::min(size.vertices, most), std::min(size.triangles, most), size.normals};
}

} // namespace vdbeam
