#include "geometry/mesh_reader.h"

#include "geometry/gltf/gltf_files.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

std::string failure(const std::string& path, const MeshParts& parts = {}) {
  try {
    read_mesh(path, parts);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was read";
  return "";
}

Vec3d corner(const Mesh& mesh, std::size_t triangle, int k) {
  return mesh.center + Vec3d(mesh.positions[mesh.triangles[triangle][k]]);
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d a = corner(mesh, i, 0);
    sum += 0.5 * length(cross(corner(mesh, i, 1) - a, corner(mesh, i, 2) - a));
  }
  return sum;
}

const char* const ply = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
0 0 5
2 0 5
2 3 5
0 3 5
3 0 1 2
3 0 2 3
)";

TEST(MeshReader, obj_polygons_without_normals) {
  const TempFolder folder;
  const std::string path = folder.file("square.obj");
  write_bytes(path, "v 0 0 5\nv 2 0 5\nv 2 3 5\nv 0 3 5\nf 1 2 3 4\n");
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_NEAR(area(mesh), 6, 1e-6);
  EXPECT_TRUE(mesh.notes.empty());
  const Vec3d a = corner(mesh, 0, 0);
  const Vec3d normal = cross(corner(mesh, 0, 1) - a, corner(mesh, 0, 2) - a);
  EXPECT_GT(normal.z, 0) << "counter-clockwise is the front";
}

TEST(MeshReader, texture_coordinates) {
  const TempFolder folder;
  const std::string path = folder.file("square.obj");
  // The third corner has another place in the picture for each of its triangles.
  write_bytes(path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                    "vt 0.5 0.25\nf 1/1 2/2 3/3\nf 1/1 3/5 4/4\n");
  EXPECT_TRUE(read_mesh(path).uvs.empty());
  const Mesh mesh = read_mesh(path, {.uvs = true});
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  ASSERT_EQ(mesh.triangles.size(), 2u);
  const Uv third = mesh.uvs[mesh.triangles[0][2]], other = mesh.uvs[mesh.triangles[1][1]];
  EXPECT_EQ(third.u, 1);
  EXPECT_EQ(third.v, 1);
  EXPECT_EQ(other.u, 0.5f);
  EXPECT_EQ(other.v, 0.25f);
}

/// v runs down in glTF.
TEST(MeshReader, texture_coordinates_of_ply_and_gltf) {
  const TempFolder folder;
  write_bytes(folder.file("t.ply"), "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nproperty float s\n"
                                    "property float t\nelement face 1\nproperty list uchar int "
                                    "vertex_indices\nend_header\n0 0 0 0.25 0.75\n1 0 0 1 0\n"
                                    "0 1 0 0 1\n3 0 1 2\n");
  const Mesh ply_mesh = read_mesh(folder.file("t.ply"), {.uvs = true});
  ASSERT_EQ(ply_mesh.uvs.size(), 3u);
  EXPECT_EQ(ply_mesh.uvs[ply_mesh.triangles[0][0]].u, 0.25f);
  EXPECT_EQ(ply_mesh.uvs[ply_mesh.triangles[0][0]].v, 0.75f);
  write_bytes(folder.file("t.gltf"), R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}],
    "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPgAAQD8AAIA/AAAAAAAAAAAAAIA/"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}]})");
  const Mesh gltf = read_mesh(folder.file("t.gltf"), {.uvs = true});
  ASSERT_EQ(gltf.uvs.size(), 3u);
  EXPECT_EQ(gltf.uvs[gltf.triangles[0][0]].u, 0.25f);
  EXPECT_EQ(gltf.uvs[gltf.triangles[0][0]].v, 0.25f);
}

TEST(MeshReader, ply_and_gltf) {
  const TempFolder folder;
  write_bytes(folder.file("square.ply"), ply);
  EXPECT_NEAR(area(read_mesh(folder.file("square.ply"))), 6, 1e-6);
  // One triangle (0 0 0), (1 0 0), (0 1 0), scaled by 2 and moved by its node.
  write_bytes(folder.file("triangle.gltf"), R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "scale": [2, 2, 2], "translation": [10, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
    "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA="}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 6, "target": 34963},
                    {"buffer": 0, "byteOffset": 8, "byteLength": 36, "target": 34962}],
    "accessors": [{"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR", "max": [2], "min": [0]},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "max": [1, 1, 0], "min": [0, 0, 0]}]})");
  const Mesh mesh = read_mesh(folder.file("triangle.gltf"));
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_NEAR(area(mesh), 2, 1e-6);
  EXPECT_NEAR(mesh.center.x, 11, 1e-6);
}

/// The corner of a triangle with the given normals: as text of an OBJ and a PLY.
TEST(MeshReader, normals_of_obj_and_ply) {
  const TempFolder folder;
  write_bytes(folder.file("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0.6 0.8\n"
                                    "f 1//1 2//2 3//1\n");
  write_bytes(folder.file("a.ply"), "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nproperty float nx\n"
                                    "property float ny\nproperty float nz\nelement face 1\n"
                                    "property list uchar int vertex_indices\nend_header\n"
                                    "0 0 0 0 0 1\n1 0 0 0 0.6 0.8\n0 1 0 0 0 1\n3 0 1 2\n");
  for (const char* name : {"a.obj", "a.ply"}) {
    EXPECT_TRUE(read_mesh(folder.file(name)).normals.empty()) << name;
    const Mesh mesh = read_mesh(folder.file(name), {.normals = true});
    ASSERT_EQ(mesh.normals.size(), 1u) << name;
    EXPECT_NEAR(mesh.normals[0][0].z, 1, 1e-6f) << name;
    EXPECT_NEAR(mesh.normals[0][1].y, 0.6f, 1e-6f) << name;
    EXPECT_TRUE(mesh.notes.empty()) << name;
  }
}

/// One triangle (0 0 0), (1 0 0), (0 1 0) under a node, with `normals` normals (1 0 1) / sqrt(2).
std::string gltf_with_normals(const std::string& node, int normals) {
  return fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
    "nodes": [{{"mesh": 0{}}}],
    "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1}}}}]}}],
    "buffers": [{{"byteLength": 72, "uri": "the%20numbers.bin"}}],
    "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 36}},
                    {{"buffer": 0, "byteOffset": 36, "byteLength": 36}}],
    "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                    "min": [0, 0, 0], "max": [1, 1, 0]}},
                  {{"bufferView": 1, "componentType": 5126, "count": {}, "type": "VEC3"}}]}})",
                     node, normals);
}

void write_numbers(const std::string& path) {
  const float slant = std::sqrt(0.5f);
  const float numbers[18] = {0,     0, 0,     1,     0, 0,     0,     1, 0,
                             slant, 0, slant, slant, 0, slant, slant, 0, slant};
  write_bytes(path, std::string(reinterpret_cast<const char*>(numbers), sizeof numbers));
}

/// Normals stay at right angles to what they belong to where a node stretches or mirrors it. The
/// buffer's name has a space, which is %20 in a URI.
TEST(MeshReader, normals_of_gltf_nodes) {
  const TempFolder folder;
  write_numbers(folder.file("the numbers.bin"));
  const std::string path = folder.file("a.gltf");
  const auto normal = [&](const char* node) {
    write_bytes(path, gltf_with_normals(node, 3));
    const Mesh mesh = read_mesh(path, {.normals = true});
    EXPECT_TRUE(mesh.notes.empty()) << node;
    return mesh.normals.at(0)[0];
  };
  const float slant = std::sqrt(0.5f), steep = std::sqrt(0.2f);
  EXPECT_LT(length(normal("") - Vec3f(slant, 0, slant)), 1e-6f);
  EXPECT_LT(length(normal(R"(, "scale": [2, 1, 1])") - Vec3f(steep, 0, 2 * steep)), 1e-6f);
  EXPECT_LT(length(normal(R"(, "scale": [-2, 1, 1])") - Vec3f(-steep, 0, 2 * steep)), 1e-6f);
  EXPECT_LT(length(normal(R"(, "scale": [1, 1, -1])") - Vec3f(slant, 0, -slant)), 1e-6f);
}

TEST(MeshReader, one_clear_line_for_wrong_normals) {
  const TempFolder folder;
  write_numbers(folder.file("the numbers.bin"));
  const std::string path = folder.file("a.gltf");
  write_bytes(path, gltf_with_normals("", 2));
  EXPECT_EQ(failure(path, {.normals = true}),
            path + ": has 2 normals for the 3 vertices of a mesh: export it again, or set "
                   "mesh.N.file_normals = false");
  EXPECT_EQ(read_mesh(path).triangles.size(), 1u);
}

/// An OBJ without the normals that its faces name is one without normals, and says so.
TEST(MeshReader, normals_that_an_obj_names_in_vain) {
  const TempFolder folder;
  const std::string path = folder.file("a.obj"), points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto notes_of = [&](const std::string& rest) {
    write_bytes(path, points + rest);
    const Mesh mesh = read_mesh(path, {.normals = true});
    EXPECT_EQ(mesh.triangles.size(), 1u) << rest;
    EXPECT_EQ(mesh.normals.empty(), !mesh.notes.empty()) << rest;
    return mesh.notes;
  };
  const auto note = [&](int corners) {
    return std::vector{fmt::format("{}: {} of its faces' corners name normals that it does not "
                                   "hold: parts with such corners are shaded by "
                                   "mesh.N.smooth_angle",
                                   path, corners)};
  };
  EXPECT_EQ(notes_of("vn 0 0.6 0.8\nf 1//1 2//2 3//1\n"), note(1));
  EXPECT_EQ(notes_of("f 1//1 2//2 3//3\n"), note(3));
  EXPECT_EQ(notes_of("vt 0 0\nvn 0 0.6 0.8\nf 1/1/1 2/1/-2 \\\n3/1/9\n"), note(2));
  EXPECT_EQ(notes_of("vn 0 0.6 0.8\nf 1//1 2//-1 3//1\n").size(), 0u);
  EXPECT_EQ(read_mesh(path).notes.size(), 0u);
  write_bytes(path, points + "f 1 2 3\nf 1/1 2/1 3/1\n");
  EXPECT_EQ(read_mesh(path, {.normals = true}).notes.size(), 0u);
}

/// A name that contains %20 comes first.
TEST(GltfFiles, are_named_by_uris) {
  const TempFolder folder;
  write_bytes(folder.file("a.gltf"), R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "100%.bin"}]})");
  const auto files = [&] { return gltf_files(folder.file("a.gltf")); };
  EXPECT_EQ(files(), (std::vector{folder.file("a b.bin"), folder.file("100%.bin")}));
  write_bytes(folder.file("a%20b.bin"), "0");
  EXPECT_EQ(files(), (std::vector{folder.file("a%20b.bin"), folder.file("100%.bin")}));
}

/// JSON may write any character as an escape, and has its own for quotes.
TEST(GltfFiles, are_named_with_escapes) {
  const TempFolder folder;
  write_bytes(folder.file("a.gltf"),
              R"({"buffers": [{"uri": "\u0061\/b.bin"}, {"uri": "say \"c\".bin"}]})");
  EXPECT_EQ(gltf_files(folder.file("a.gltf")),
            (std::vector{folder.file("a/b.bin"), folder.file("say \"c\".bin")}));
}

/// A binary glTF may name files beside it as well.
TEST(GltfFiles, are_named_by_binary_files) {
  const TempFolder folder;
  const std::string json = R"({"buffers": [{"uri": "a.bin"}]})";
  const std::string length(1, static_cast<char>(json.size()));
  const std::string zeros(3, '\0');
  write_bytes(folder.file("a.glb"), "glTF" + std::string("\2\0\0\0", 4) +
                                        std::string("\0\0\0\0", 4) + length + zeros + "JSON" +
                                        json);
  EXPECT_EQ(gltf_files(folder.file("a.glb")), std::vector{folder.file("a.bin")});
}

/// A small file may name a large one: what reading may take goes by both.
TEST(MeshReader, gltf_with_a_large_buffer) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf"), buffer = folder.file("the numbers.bin");
  write_numbers(buffer);
  std::filesystem::resize_file(buffer, 300'000'000);
  std::string gltf = gltf_with_normals("", 3);
  gltf.replace(gltf.find("72"), 2, "300000000");
  write_bytes(path, gltf);
  EXPECT_EQ(read_mesh(path).triangles.size(), 1u);
}

/// Files that are named may be anything: a pipe without an end is as good as no file.
TEST(MeshReader, pipes_that_a_file_names_are_not_read) {
  const TempFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  write_bytes(folder.file("a.obj"), "mtllib pipe\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_mesh(folder.file("a.obj"), {}, {.seconds = 5}).triangles.size(), 1u);
  std::string gltf = gltf_with_normals("", 3);
  gltf.replace(gltf.find("the%20numbers.bin"), 17, "pipe");
  write_bytes(folder.file("a.gltf"), gltf);
  EXPECT_EQ(failure(folder.file("a.gltf")).find("took"), std::string::npos);
}

/// assimp looks for the end of this header for ever.
TEST(MeshReader, small_files_have_little_time) {
  const TempFolder folder;
  const std::string path = folder.file("cut.ply"), whole = ply;
  write_bytes(path, whole.substr(0, whole.find("property float z")));
  EXPECT_NE(failure(path).find("processor time; the file is corrupt"), std::string::npos);
}

TEST(MeshReader, far_from_the_origin_keeps_its_shape) {
  const TempFolder folder;
  const std::string path = folder.file("far.obj");
  write_bytes(path, "v 1048576 0 0\nv 1048577 0 0\nv 1048576 1 0\nf 1 2 3\n");
  const Mesh mesh = read_mesh(path);
  EXPECT_NEAR(area(mesh), 0.5, 1e-6);
  EXPECT_NEAR(mesh.center.x, 1048576.5, 1e-9);
}

TEST(RepairMesh, drops_what_cannot_be_used_and_says_so) {
  RawMesh raw;
  raw.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {NAN, 0, 0}, {1e300, 0, 0}};
  raw.triangles = {{0, 1, 2}, {0, 1, 9}, {0, 1, 3}, {0, 1, 4}, {0, 1, 1}};
  const Mesh mesh = repair_mesh(raw, "label");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "label: triangles left out: 1 with wrong indices, 2 with vertices that "
                           "are not finite, 1 without area");
  raw.triangles = {{0, 1, 9}};
  EXPECT_THROW(repair_mesh(raw, "label"), FrameError);
}

TEST(MeshReader, one_clear_line_for_what_is_no_mesh) {
  const TempFolder folder;
  EXPECT_NE(failure(folder.file("no.obj")).find("No such file"), std::string::npos);
  write_bytes(folder.file("a.txt"), "hello");
  EXPECT_NE(failure(folder.file("a.txt")).find("is not a mesh file: give an .obj"),
            std::string::npos);
  write_bytes(folder.file("empty.ply"), "");
  EXPECT_NE(failure(folder.file("empty.ply")).find("is empty"), std::string::npos);
  write_bytes(folder.file("points.obj"), "v 0 0 0\nv 1 0 0\n");
  EXPECT_NE(failure(folder.file("points.obj")).find("points.obj"), std::string::npos);
}

/// Whatever is wrong with a file, reading ends with a mesh or with an error of one line.
TEST(MeshReader, broken_files_end_in_one_line) {
  const TempFolder folder;
  const std::string path = folder.file("broken.ply");
  const std::string whole = ply;
  int failures = 0;
  for (std::size_t cut = 0; cut < whole.size(); cut += 31) {
    for (const std::string& text :
         {whole.substr(0, cut + 1), whole.substr(0, cut) + "999999999 " + whole.substr(cut)}) {
      write_bytes(path, text);
      try {
        read_mesh(path, {}, {.seconds = 0.5});
      } catch (const Error& error) {
        ++failures;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  }
  EXPECT_GT(failures, 5);
}

} // namespace
} // namespace vdbeam
