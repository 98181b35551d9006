// Meshes, textures and Embree's trees are kept from frame to frame and from moment to moment as
// long as their files are the same, and the pictures are those of frames that are rendered alone.
#include "prepare/prepared_scene.h"
#include "support/temp_folder.h"
#include "vdbeam/image_file.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace vdbeam {
namespace {

/// Meshes read, textures read, trees built.
using Work = std::array<std::uint64_t, 3>;

Work work_of(const RenderResult& result) {
  return {result.statistics.meshes_read, result.statistics.textures_read,
          result.statistics.trees_built};
}

/// A textured square from a file that comes twice, a ball, and a sky.
class SurfaceReuse : public ::testing::Test {
protected:
  SurfaceReuse() {
    write_square(1);
    write_picture(0.25f);
    std::ofstream(folder_.file("s.toml"))
        << "image = { width = 24, height = 16 }\n"
           "camera = { position = [0, 0, 8], shutter_times = 4 }\n"
           "[[mesh]]\nfile = \"square.obj\"\n"
           "material = { type = \"diffuse\", texture = \"picture.exr\" }\n"
           "[[mesh]]\nfile = \"square.obj\"\ntranslate = [2, 0, -1]\n"
           "[[mesh]]\ntype = \"sphere\"\nscale = 0.5\ntranslate = [0, 0, 1]\n"
           "[[light]]\ntype = \"environment\"\n"
           "[render]\nestimator = \"path\"\npasses = 8\n";
  }
  void write_square(double size) const {
    std::ofstream(folder_.file("square.obj"))
        << fmt::format("v -{0} -{0} 0\nv {0} -{0} 0\nv {0} {0} 0\nv -{0} {0} 0\n"
                       "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
                       size);
  }
  void write_picture(float value) const {
    Image image;
    image.width = image.height = 2;
    for (const char* name : {"R", "G", "B"})
      image.channels.push_back({name, {value, 0.5f, 0.75f, 1}});
    write_exr(image, folder_.file("picture.exr"));
  }
  /// Files that are written within one tick of the clock differ all the same.
  void make_newer(const std::string& name) const {
    const std::filesystem::path path = folder_.file(name);
    std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) +
                                               std::chrono::seconds(++age_));
  }
  Scene load(const std::vector<std::string>& more = {}) const {
    return load_scene(folder_.file("s.toml"), 1, more);
  }
  /// The work for a frame after the one that is prepared.
  Work next(const std::vector<std::string>& more = {}) {
    const Scene scene = load(more);
    prepared_ = prepare_scene(scene, prepared_);
    const RenderResult result = render(scene, prepared_);
    const Image alone = render(scene).image;
    for (const ImageChannel& channel : result.image.channels)
      EXPECT_EQ(channel.data, alone.find(channel.name)->data) << channel.name;
    return work_of(result);
  }

  test::TempFolder folder_;
  PreparedScenePtr prepared_;
  mutable int age_ = 0;
};

TEST_F(SurfaceReuse, what_moves_rigidly_is_neither_read_nor_built_again) {
  EXPECT_EQ(next(), (Work{1, 1, 2}));
  EXPECT_EQ(next(), (Work{0, 0, 0})); // the whole world is the same
  EXPECT_EQ(next({"mesh.0.translate=[0.3,0.1,0]"}), (Work{0, 0, 0}));
  EXPECT_EQ(next({"mesh.0.rotate=[0,40,0]", "mesh.2.translate=[0,1,1]"}), (Work{0, 0, 0}));
  EXPECT_EQ(next({"mesh.0.material.albedo=[0.1,0.2,0.3]"}), (Work{0, 0, 0}));
  EXPECT_EQ(next({"light.0.radiance=[2,1,1]", "mesh.1.material=mirror"}), (Work{0, 0, 0}));
}

TEST_F(SurfaceReuse, what_changes_is_made_again) {
  EXPECT_EQ(next(), (Work{1, 1, 2}));
  write_square(1.5);
  make_newer("square.obj");
  EXPECT_EQ(next(), (Work{1, 0, 1}));
  write_picture(0.75f);
  make_newer("picture.exr");
  EXPECT_EQ(next(), (Work{0, 1, 0}));
  EXPECT_EQ(next({"mesh.0.material.texture_wrap=clamp"}), (Work{0, 1, 0}));
  EXPECT_EQ(next({"mesh.0.material=mirror"}), (Work{1, 0, 1})); // without UV
  // Rays that come from far away are rounded more: boxes must be wider, and narrow again later.
  EXPECT_EQ(next({"mesh.1.translate=[1000,0,0]"}), (Work{1, 1, 2}));
  EXPECT_EQ(next(), (Work{0, 0, 2}));
}

/// A .gltf file whose numbers are in a file of another name.
TEST_F(SurfaceReuse, buffers_of_gltf_files_are_part_of_them) {
  std::ofstream(folder_.file("triangle.gltf"))
      << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "buffers": [{"byteLength": 36, "uri" : "points.bin"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [-2, -2, 0], "max": [2, 2, 0]}]})";
  const auto write_points = [&](float size) {
    const float points[9] = {-size, -size, 0, size, -size, 0, 0, size, 0};
    std::ofstream(folder_.file("points.bin"), std::ios::binary)
        .write(reinterpret_cast<const char*>(points), sizeof points);
  };
  write_points(1);
  const std::vector<std::string> more = {"mesh.1.file=" + folder_.file("triangle.gltf")};
  EXPECT_EQ(next(more), (Work{2, 1, 3}));
  EXPECT_EQ(next(more), (Work{0, 0, 0}));
  const std::string before = scene_hash(load(more));
  write_points(1.5f);
  make_newer("points.bin");
  EXPECT_EQ(next(more), (Work{1, 0, 1}));
  EXPECT_NE(scene_hash(load(more)), before);
}

TEST_F(SurfaceReuse, moments_of_a_shutter_share_all_of_it) {
  const RenderResult result =
      render(load({"camera.shutter_close=1", "mesh.0.translate={keys=[[1,[0,0,0]],[2,[1,1,0]]]}"}));
  EXPECT_EQ(work_of(result), (Work{1, 1, 2}));
}

} // namespace
} // namespace vdbeam
