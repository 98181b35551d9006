#include "geometry/mesh_reader.h"

#include "geometry/gltf/gltf_camera.h"
#include "geometry/gltf/gltf_files.h"
#include "geometry/gltf/gltf_json.h"
#include "geometry/gltf/gltf_motion.h"
#include "geometry/gltf/gltf_parts.h"
#include "geometry/obj_normals.h"
#include "geometry/uri_files.h"
#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace vdbeam {
namespace {

constexpr const char* kinds = "an .obj, .ply, .gltf or .glb file";

} // namespace

bool is_mesh_file(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  return extension == ".obj" || extension == ".ply" || is_gltf_file(path);
}

namespace {

/// Bytes of the file and of those that it names.
std::uint64_t check_file(const std::string& path) {
  const std::uint64_t bytes = check_input_file(path);
  if (!is_mesh_file(path))
    throw InputError(fmt::format("{}: is not a mesh file: give {}", path, kinds));
  return bytes + bytes_of_gltf_files(path);
}

/// Throws FrameError where a mesh has not one normal per vertex: assimp leaves such normals out
/// without a word, and the mesh would be flat.
void check_gltf_normals(const std::string& path) {
  const nlohmann::json gltf = read_gltf_json(path);
  for (const auto& mesh : gltf.at("meshes"))
    for (const auto& primitive : mesh.at("primitives")) {
      const auto& attributes = primitive.at("attributes");
      if (!attributes.contains("NORMAL"))
        continue;
      const std::uint64_t normals = accessor_count(gltf, attributes.at("NORMAL"));
      const std::uint64_t vertices = accessor_count(gltf, attributes.at("POSITION"));
      if (normals != vertices)
        throw FrameError(fmt::format("{}: has {} normals for the {} vertices of a mesh: export it "
                                     "again, or set mesh.N.file_normals = false",
                                     path, normals, vertices));
    }
}

/// Limits that a sound file of this size cannot exceed. An OBJ file needs about two bytes per
/// index, and assimp makes a vertex with all attributes of each. On some damaged files assimp never
/// ends, so the time for a small one is short.
GuardLimits guard_limits(std::uint64_t file_bytes, const MeshLimits& limits) {
  GuardLimits guard;
  guard.seconds = limits.seconds + time_for(file_bytes);
  guard.cpu_seconds = std::min(guard.seconds, 2 + 5e-6 * static_cast<double>(file_bytes));
  guard.bytes = std::min(limits.bytes, (std::uint64_t(256) << 20) + 200 * file_bytes);
  return guard;
}

/// The normals of a part that has been appended; zero where it has none.
void append_normals(const aiMesh& mesh, const Affine& map, RawMesh& raw) {
  if (!mesh.mNormals)
    return;
  raw.normals.resize(raw.positions.size());
  // They go by the transposed inverse; what is left of its determinant is their length.
  const auto &x = map.rows[0], &y = map.rows[1], &z = map.rows[2];
  const double sign = map.determinant() < 0 ? -1 : 1;
  const Vec3d c0 = cross(y, z) * sign, c1 = cross(z, x) * sign, c2 = cross(x, y) * sign;
  const std::size_t first = raw.positions.size() - mesh.mNumVertices;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& a = mesh.mNormals[i];
    const Vec3d n{a.x, a.y, a.z};
    const Vec3d mapped{dot(c0, n), dot(c1, n), dot(c2, n)};
    raw.normals[first + i] = Vec3f(normalize(mapped));
  }
}

void append_mesh(const aiMesh& mesh, const Affine& map, RawMesh& raw) {
  const auto first = static_cast<std::uint32_t>(raw.positions.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& p = mesh.mVertices[i];
    raw.positions.push_back(map.point({p.x, p.y, p.z}));
    if (const aiVector3D* uv = mesh.mTextureCoords[0])
      raw.uvs.push_back({static_cast<float>(uv[i].x), static_cast<float>(uv[i].y)});
  }
  append_normals(mesh, map, raw);
  // A map that mirrors turns triangles inside out.
  const bool mirrors = map.determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3)
      continue;
    std::array<std::uint32_t, 3> t;
    for (int k = 0; k < 3; ++k) {
      const unsigned index = face.mIndices[k];
      t[k] = index < mesh.mNumVertices ? first + index : ~std::uint32_t(0);
    }
    if (mirrors)
      std::swap(t[1], t[2]);
    raw.triangles.push_back(t);
  }
}

/// What append_node takes of a scene, and where.
struct Selection {
  const aiScene& scene;
  std::vector<bool> taken; ///< per material, whether its triangles are; empty: all are
  GltfMotion motion;
  std::optional<double> seconds;
};

void append_node(const Selection& from, const aiNode& node, const Affine& parent, RawMesh& raw) {
  const aiScene& scene = from.scene;
  const std::vector<bool>& taken = from.taken;
  const Affine map = parent.after(from.seconds ? from.motion.matrix(node, *from.seconds)
                                               : GltfMotion::at_rest(node));
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    if (node.mMeshes[i] < scene.mNumMeshes)
      if (const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
          taken.empty() || (mesh.mMaterialIndex < taken.size() && taken[mesh.mMaterialIndex]))
        append_mesh(mesh, map, raw);
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    append_node(from, *node.mChildren[i], map, raw);
}

struct Counts {
  std::uint64_t positions = 0, uvs = 0, normals = 0, triangles = 0;
  std::uint64_t missing_normals = 0; ///< corners that name one that is not there
  std::uint64_t unused = 0;          ///< bits of UnusedParts
};

/// What is not used of a glTF, and the notes about it.
enum UnusedParts : std::uint64_t { unused_skins = 1, unused_morphs = 2, unused_curves = 4 };
constexpr std::pair<std::uint64_t, const char*> unused_notes[] = {
    {unused_skins, "its skins are not applied: its meshes are as they were bound to their bones"},
    {unused_morphs, "its morph targets are not applied"},
    {unused_curves, "its animation has steps or splines, which are interpolated linearly"}};

/// What of a glTF is not used, by what its JSON says.
std::uint64_t unused_parts(const nlohmann::json& gltf, bool animated) {
  std::uint64_t unused = 0;
  const auto list = [](const nlohmann::json& json, const char* name) {
    return json.is_object() && json.contains(name) && json[name].is_array()
               ? json[name]
               : nlohmann::json::array();
  };
  for (const auto& node : list(gltf, "nodes"))
    if (node.is_object() && node.contains("skin"))
      unused |= unused_skins;
  for (const auto& mesh : list(gltf, "meshes"))
    for (const auto& primitive : list(mesh, "primitives"))
      if (!list(primitive, "targets").empty())
        unused |= unused_morphs;
  for (const auto& animation : animated ? list(gltf, "animations") : nlohmann::json::array())
    for (const auto& sampler : list(animation, "samplers"))
      if (sampler.is_object() && sampler.contains("interpolation") &&
          sampler["interpolation"] != "LINEAR")
        unused |= unused_curves;
  return unused;
}

/// Corners of an OBJ file that name normals in vain, which left some of its parts without.
std::uint64_t normals_named_in_vain(const std::string& path, const aiScene& scene) {
  bool some_flat = false;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i)
    some_flat = some_flat || !scene.mMeshes[i]->mNormals;
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  return some_flat && extension == ".obj" ? count_missing_normals(path) : 0;
}

/// In the child: parses the file and writes counts, positions, texture coordinates, normals and
/// triangles.
void parse(const std::string& path, const MeshParts& parts, int output) {
  if (parts.normals && is_gltf_file(path))
    try {
      check_gltf_normals(path);
    } catch (const nlohmann::json::exception&) { // assimp will complain
    }
  Assimp::Importer importer;
  open_uris(importer);
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      (parts.normals ? 0 : int{aiComponent_NORMALS}) | aiComponent_TANGENTS_AND_BITANGENTS |
          aiComponent_COLORS | (parts.uvs ? 0 : int{aiComponent_TEXCOORDS}) |
          aiComponent_BONEWEIGHTS | (parts.seconds ? 0 : int{aiComponent_ANIMATIONS}) |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  const aiScene* scene = importer.ReadFile(path, aiProcess_RemoveComponent | aiProcess_Triangulate |
                                                     aiProcess_JoinIdenticalVertices);
  if (!scene)
    throw std::runtime_error(importer.GetErrorString());
  RawMesh raw;
  Selection selection{*scene, {}, GltfMotion(*scene), parts.seconds};
  if (parts.material >= 0)
    for (const int index : gltf_material_indices(path, *scene))
      selection.taken.push_back(index == parts.material);
  if (scene->mRootNode)
    append_node(selection, *scene->mRootNode, {}, raw);
  if (raw.uvs.size() != raw.positions.size())
    raw.uvs.clear();
  if (!raw.normals.empty())
    raw.normals.resize(raw.positions.size());
  const Counts counts{
      raw.positions.size(),
      raw.uvs.size(),
      raw.normals.size(),
      raw.triangles.size(),
      parts.normals ? normals_named_in_vain(path, *scene) : 0,
      is_gltf_file(path) ? unused_parts(read_gltf_json(path), parts.seconds.has_value()) : 0};
  write_all(output, &counts, sizeof counts);
  write_all(output, raw.positions.data(), raw.positions.size() * sizeof raw.positions[0]);
  write_all(output, raw.uvs.data(), raw.uvs.size() * sizeof raw.uvs[0]);
  write_all(output, raw.normals.data(), raw.normals.size() * sizeof raw.normals[0]);
  write_all(output, raw.triangles.data(), raw.triangles.size() * sizeof raw.triangles[0]);
}

/// Takes values off what is left of the child's answer; false where there are fewer.
template <class T>
bool take(const std::byte*& data, std::uint64_t& rest, std::uint64_t count,
          std::vector<T>& values) {
  if (count > rest / sizeof(T))
    return false;
  values.resize(count);
  std::copy_n(data, count * sizeof(T), reinterpret_cast<std::byte*>(values.data()));
  data += count * sizeof(T);
  rest -= count * sizeof(T);
  return true;
}

} // namespace

Mesh read_mesh(const std::string& path, const MeshParts& parts, const MeshLimits& limits) {
  const std::uint64_t bytes = check_file(path);
  const MappedFile file = run_guarded(path, guard_limits(bytes, limits),
                                      [&](int output) { parse(path, parts, output); });
  RawMesh raw;
  Counts counts;
  std::uint64_t rest = file.size();
  if (rest >= sizeof counts) {
    std::memcpy(&counts, file.data(), sizeof counts);
    const std::byte* data = file.data() + sizeof counts;
    rest -= sizeof counts;
    if (take(data, rest, counts.positions, raw.positions) &&
        take(data, rest, counts.uvs, raw.uvs) && take(data, rest, counts.normals, raw.normals) &&
        take(data, rest, counts.triangles, raw.triangles) && rest == 0) {
      Mesh mesh = repair_mesh(raw, path);
      if (counts.missing_normals > 0)
        mesh.notes.push_back(fmt::format(
            "{}: {} of its faces' corners name normals that it does not hold: parts with such "
            "corners are shaded by mesh.N.smooth_angle",
            path, counts.missing_normals));
      for (const auto& [bit, note] : unused_notes)
        if (counts.unused & bit)
          mesh.notes.push_back(fmt::format("{}: {}", path, note));
      return mesh;
    }
  }
  throw FrameError(path + ": the reader returned too little");
}

} // namespace vdbeam
