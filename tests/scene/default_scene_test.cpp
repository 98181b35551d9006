#include "scene_fixture.h"
#include "vdbeam/render.h"
#include "volume_factory.h"

#include <algorithm>
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
  EXPECT_EQ(scene.lights[1].type, LightType::sky);
  EXPECT_EQ(scene.render.passes, 64);
  ASSERT_EQ(scene.notes.size(), 2u);
  EXPECT_NE(scene.notes[0].find("Y is taken to be up"), std::string::npos);
  EXPECT_NE(scene.notes[1].find("extinction"), std::string::npos);
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
  std::string text = scene_template(cloud, folder_.string(), true);
  const std::size_t tables = text.find("# [[mesh]]"); // tested below
  text.erase(tables, text.find("[render]") - tables);
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

std::size_t count_keys(const std::string& text) {
  std::size_t count = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    count += line.find(" = ") < line.find("# ", 2) ? 1 : 0;
  return count;
}

/// All keys or the first ones: the scene is the same. The tables of meshes and layers are valid
/// where the comment marks are removed.
TEST_F(DefaultScene, TemplateShowsTheKeysThatMatterFirst) {
  const std::string text = scene_template(cloud, folder_.string());
  const std::string all_keys = scene_template(cloud, folder_.string(), true);
  EXPECT_LT(count_keys(text), 40u) << text;
  EXPECT_GT(count_keys(all_keys), 100u);
  const Scene scene = load_scene(write("first.toml", text));
  EXPECT_EQ(scene_hash(scene), scene_hash(load_scene(write("all.toml", all_keys))));
  const std::size_t mesh = text.find("# [[mesh]]"), render = text.find("[render]");
  ASSERT_LT(mesh, render);
  std::string tables = text.substr(mesh, render - mesh);
  for (std::size_t at = 0; at < tables.size(); at = tables.find('\n', at) + 1)
    if (tables.compare(at, 2, "# ") == 0)
      tables.erase(at, 2);
  const Scene more =
      load_scene(write("more.toml", text.substr(0, mesh) + tables + text.substr(render)));
  EXPECT_EQ(more.surfaces.size(), 1u);
  EXPECT_EQ(more.layers.size(), 1u);
}

/// The depth and albedo of a simulation are those of smoke, of a fire those of soot.
TEST_F(DefaultScene, SmokeIsThinnerAndDarkerThanACloud) {
  const Scene water = load_scene(cloud);
  const Scene smoke = load_scene(VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb");
  const Scene fire = load_scene(VDBEAM_SOURCE_DIR "/data/fire/fire.0014.vdb");
  EXPECT_EQ(water.volumes[0].albedo.x, 0.98f);
  EXPECT_EQ(smoke.volumes[0].albedo.x, 0.75f);
  EXPECT_EQ(fire.volumes[0].albedo.x, 0.5f);
  EXPECT_EQ(smoke.volumes[0].interpolation, Interpolation::linear);
  EXPECT_EQ(fire.volumes[0].interpolation, Interpolation::cubic);
  // Sunlight comes from the side and from behind: it travels towards the camera, along -y.
  EXPECT_LT(smoke.lights[0].direction.y, 0);
  EXPECT_TRUE(std::any_of(smoke.notes.begin(), smoke.notes.end(), [](const std::string& note) {
    return note.find("taken as smoke") != std::string::npos;
  }));
}

TEST_F(DefaultScene, HeatOrVelocityMakesAFileASmoke) {
  VolumeOptions options;
  options.size = 16;
  write_volume("simulation", file("simulation.vdb"), options);
  write_volume("noise", file("noise.vdb"), options);
  EXPECT_EQ(load_scene(file("simulation.vdb")).volumes[0].albedo.x, 0.75f);
  EXPECT_EQ(load_scene(file("noise.vdb")).volumes[0].albedo.x, 0.98f);
}

TEST_F(DefaultScene, FileNamesAreQuoted) {
  const std::string odd = file("a \"b\" \\c.vdb");
  std::filesystem::copy_file(cloud, odd);
  const std::string path = write("odd.toml", scene_template(odd, folder_.string()));
  EXPECT_EQ(load_scene(path).volumes.at(0).file, odd);
}

/// What of the picture the grid's voxels fill: columns and rows, as shares of width and height.
struct Filled {
  double left = 1, right = 0, top = 1, bottom = 0;
};
Filled filled_part(const std::string& path, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all{"image.width=96", "image.height=54", "render.passes=1",
                               "render.estimator=path", "render.max_bounces=1"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const Scene scene = load_scene(path, 1, all);
  const RenderResult result = render(scene);
  const std::vector<float>& opacity = result.image.find("A")->data;
  Filled part;
  for (int y = 0; y < 54; ++y)
    for (int x = 0; x < 96; ++x)
      if (opacity[static_cast<std::size_t>(96 * y + x)] > 0.02f) {
        part.left = std::min(part.left, x / 96.0);
        part.right = std::max(part.right, (x + 1) / 96.0);
        part.top = std::min(part.top, y / 54.0);
        part.bottom = std::max(part.bottom, (y + 1) / 54.0);
      }
  return part;
}

/// Nothing is cut off, and one side of the picture is nearly full; the object stands in its middle.
void expect_framed(const Filled& part) {
  EXPECT_GT(part.left, 0.01);
  EXPECT_GT(part.top, 0.01);
  EXPECT_LT(part.right, 0.99);
  EXPECT_LT(part.bottom, 0.99);
  EXPECT_GT(std::max(part.right - part.left, part.bottom - part.top), 0.8);
  EXPECT_NEAR((part.left + part.right) / 2, 0.5, 0.05);
  EXPECT_NEAR((part.top + part.bottom) / 2, 0.5, 0.05);
}

TEST_F(DefaultScene, FramesTheObjectTightly) {
  expect_framed(filled_part(cloud));
  expect_framed(filled_part(VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb"));
  expect_framed(filled_part(VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb", {"camera.up=[1,0,0]"}));
}

TEST_F(DefaultScene, DoesNotCropSmallGrids) {
  VolumeOptions options;
  options.size = 8;
  write_volume("box", file("box.vdb"), options);
  expect_framed(filled_part(file("box.vdb")));
}

TEST_F(DefaultScene, BlendersSimulationsStandUpright) {
  const std::string smoke = VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb";
  const Scene scene = load_scene(smoke);
  EXPECT_EQ(scene.camera.up, Vec3d(0, 0, 1));
  EXPECT_LT(scene.camera.position.y, scene.camera.look_at.y); // looks along +Y
  EXPECT_LT(scene.lights[0].direction.z, 0);
  EXPECT_NE(scene.notes.at(0).find("Z is up"), std::string::npos);
  const Scene asked = load_scene(smoke, 1, {"camera.up=[0,1,0]"});
  EXPECT_EQ(asked.camera.up, Vec3d(0, 1, 0));
  EXPECT_EQ(asked.notes.at(0).find("is up"), std::string::npos) << "nothing is assumed";
}

TEST_F(DefaultScene, BadVolumes) {
  EXPECT_THROW(load_scene(file("none.vdb")), InputError);
  EXPECT_THROW(load_scene(write("text.vdb", "hello")), Error);
}

} // namespace
} // namespace vdbeam
