#include "geometry/mesh_size.h"

#include "geometry/mesh_reader.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

TEST(MeshSize, IsWhatTheReaderFinds) {
  const TempFolder folder;
  write_bytes(folder.file("a.ply"), "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                                    "property float y\nproperty float z\nelement face 2\nproperty "
                                    "list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n"
                                    "1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  write_bytes(folder.file("b.obj"), "# a pentagon and a triangle\nv 0 0 0\nv 1 0 0\nv 2 1 0\n"
                                    "v 1 2 0\nv 0 2 0\nvn 0 0 1\nf 1//1  2//1 3//1 4//1 5//1\n"
                                    "f 1 2 3 \n");
  for (const auto& [name, vertices] : {std::pair{"a.ply", 4u}, {"b.obj", 5u}}) {
    const MeshSize size = foretell_mesh(folder.file(name));
    EXPECT_EQ(size.vertices, vertices) << name;
    EXPECT_EQ(size.normals, name == std::string("b.obj")) << name;
    EXPECT_EQ(size.triangles, read_mesh(folder.file(name)).triangles.size()) << name;
  }
}

TEST(MeshSize, CountsWhatNodesOfAGltfShow) {
  const TempFolder folder;
  const std::string json = R"({"nodes": [{"mesh": 0}, {}, {"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0},
                               {"attributes": {"POSITION": 1}}]}],
    "accessors": [{"count": 6}, {"count": 9}]})";
  write_bytes(folder.file("c.gltf"), json);
  EXPECT_EQ(foretell_mesh(folder.file("c.gltf")).triangles, 10u);
  EXPECT_EQ(foretell_mesh(folder.file("c.gltf")).vertices, 36u);
  std::string glb("glTF\2\0\0\0\0\0\0\0", 12);
  const auto length = static_cast<char>(json.size() & 255),
             high = static_cast<char>(json.size() >> 8);
  glb += std::string({length, high, '\0', '\0'}) + "JSON" + json;
  write_bytes(folder.file("d.glb"), glb);
  EXPECT_EQ(foretell_mesh(folder.file("d.glb")).triangles, 10u);
}

TEST(MeshSize, ReportsNormals) {
  const TempFolder folder;
  write_bytes(folder.file("a.ply"), "ply\nelement vertex 3\nproperty double nx\nend_header\n");
  write_bytes(folder.file("a.gltf"),
              R"({"nodes": [{"mesh": 0}], "accessors": [{"count": 6}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}}]}]})");
  EXPECT_TRUE(foretell_mesh(folder.file("a.ply")).normals);
  EXPECT_TRUE(foretell_mesh(folder.file("a.gltf")).normals);
}

TEST(MeshSize, OfDamagedFilesIsZero) {
  const TempFolder folder;
  for (const char* name : {"a.ply", "a.obj", "a.gltf", "a.glb"})
    for (const char* bytes : {"", "garbage", "{\"nodes\": [{\"mesh\": 7}]}", "glTF"}) {
      write_bytes(folder.file(name), bytes);
      EXPECT_EQ(foretell_mesh(folder.file(name)).triangles, 0u) << name << bytes;
    }
}

/// A pipe would never end; a line of 30 GB, which takes no room on the disk, would fill the memory.
TEST(MeshSize, OfHostileFilesIsZero) {
  const TempFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe.ply").c_str(), 0600), 0);
  EXPECT_EQ(foretell_mesh(folder.file("pipe.ply")).triangles, 0u);
  write_bytes(folder.file("line.obj"), "v");
  std::filesystem::resize_file(folder.file("line.obj"), std::uintmax_t(30) << 30);
  EXPECT_EQ(foretell_mesh(folder.file("line.obj")).triangles, 0u);
}

TEST(MeshSize, IsBelievedWithinReasonOnly) {
  const TempFolder folder;
  write_bytes(folder.file("a.ply"), "ply\nelement face 18446744073709551615\nend_header\n");
  EXPECT_LT(foretell_mesh(folder.file("a.ply")).triangles, std::uint64_t(1) << 40);
}

} // namespace
} // namespace vdbeam
