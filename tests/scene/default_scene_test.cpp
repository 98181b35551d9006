#include "scene_fixture.h"

#include <cmath>

namespace vdbeam {
namespace {

using DefaultScene = test::SceneTest;

const std::string cloud = VDBEAM_SOURCE_DIR "/data/cloud.vdb";

TEST_F(DefaultScene, ShowsABareVdb) {
  const Scene scene = load_scene(cloud);
  ASSERT_EQ(scene.volumes.size(), 1u);
  EXPECT_EQ(scene.volumes[0].file, cloud);
  EXPECT_EQ(scene.volumes[0].density, "density");
  // The scene file that people made for this cloud has 40.
  EXPECT_GT(scene.volumes[0].extinction, 20);
  EXPECT_LT(scene.volumes[0].extinction, 120);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].type, LightType::distant);
  EXPECT_LT(scene.lights[0].direction.y, 0);
  EXPECT_EQ(scene.lights[1].type, LightType::environment);
  EXPECT_EQ(scene.render.passes, 64);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("extinction"), std::string::npos);
  EXPECT_NO_THROW(validate_scene(scene));
}

TEST_F(DefaultScene, OverridesSteerTheChoices) {
  const Scene scene = load_scene(
      cloud, 1,
      {"camera.up=[0,0,1]", "image.width=100", "image.height=300", "volume.0.extinction=3"});
  EXPECT_EQ(scene.camera.up, Vec3d(0, 0, 1));
  EXPECT_LT(scene.camera.position.y, scene.camera.look_at.y); // looks along +Y
  EXPECT_LT(scene.lights[0].direction.z, 0);
  EXPECT_EQ(scene.image.height, 300);
  EXPECT_EQ(scene.volumes[0].extinction, 3);
  const Scene wide = load_scene(cloud, 1, {"image.width=1000", "image.height=100"});
  EXPECT_GT(length(scene.camera.position), 1.5 * length(wide.camera.position) / 3);
}

TEST_F(DefaultScene, OneCameraForASequence) {
  const std::string smoke = VDBEAM_SOURCE_DIR "/data/smoke/smoke.####.vdb";
  const Scene first = load_scene(smoke, 1), last = load_scene(smoke, 24);
  EXPECT_EQ(first.camera.position, last.camera.position);
  EXPECT_EQ(first.volumes[0].extinction, last.volumes[0].extinction);
  EXPECT_NE(first.volumes[0].file, last.volumes[0].file);
}

TEST_F(DefaultScene, TemplateGivesTheSameScene) {
  const std::string path = write("cloud.toml", scene_template(cloud, folder_.string()));
  const Scene from_file = load_scene(path), bare = load_scene(cloud);
  EXPECT_EQ(from_file.camera.position, bare.camera.position);
  EXPECT_EQ(from_file.volumes[0].extinction, bare.volumes[0].extinction);
  EXPECT_EQ(scene_hash(from_file), scene_hash(bare));
}

TEST_F(DefaultScene, CommentedLinesOfTheTemplateAreValidToo) {
  std::string text = scene_template(cloud, folder_.string());
  std::string uncommented;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool setting = line.starts_with("# ") && line.find(" = ") < line.find("# ", 2) &&
                         line.find("transform") == std::string::npos;
    uncommented += (setting ? line.substr(2) : line) + "\n";
  }
  EXPECT_NE(uncommented, text);
  const std::string path = write("all.toml", uncommented);
  EXPECT_NO_THROW(load_scene(path));
}

TEST_F(DefaultScene, FileNamesAreQuoted) {
  const std::string odd = file("a \"b\" \\c.vdb");
  std::filesystem::copy_file(cloud, odd);
  const std::string path = write("odd.toml", scene_template(odd, folder_.string()));
  EXPECT_EQ(load_scene(path).volumes.at(0).file, odd);
}

TEST_F(DefaultScene, BadVolumes) {
  EXPECT_THROW(load_scene(file("none.vdb")), InputError);
  EXPECT_THROW(load_scene(write("text.vdb", "hello")), Error);
}

} // namespace
} // namespace vdbeam
