#include "scene_fixture.h"

namespace vdbeam {
namespace {

using SceneFile = test::SceneTest;

const char* const tables = R"(
[image]
width = 320
height = 180
[camera]
position = [0.3, 1.2, 7]
look_at = [0.02, 0.5, 0.0]
up = [0, 0, 1]
fov = 24
[[volume]]
file = "cloud.vdb"
density = "soot"
extinction = 40
extinction_scale = [1, 2, 3]
albedo = [0.99, 0.98, 0.5]
phase = { type = "two_lobe", g = 0.6, g2 = -0.3, blend = 0.25 }
[[light]]
type = "distant"
direction = [-0.55, -0.66, -0.44]
irradiance = [5, 4, 3]
angular_radius = 0.27
direct = "photons"
[[light]]
type = "environment"
radiance = 0.25
[render]
estimator = "march"
time = "1h30m"
photons = 1e6
store = "scatter"
kernel = "fixed"
radius = 0.125
kernel_shape = "epanechnikov"
max_bounces = 3
seed = 9
threads = 2
)";

TEST_F(SceneFile, ReadsEveryTable) {
  const Scene scene = load(tables);
  EXPECT_EQ(scene.image.width, 320);
  EXPECT_EQ(scene.image.height, 180);
  EXPECT_EQ(scene.camera.position, Vec3d(0.3, 1.2, 7));
  EXPECT_EQ(scene.camera.up, Vec3d(0, 0, 1));
  EXPECT_EQ(scene.camera.fov, 24);
  ASSERT_EQ(scene.volumes.size(), 1u);
  const VolumeSettings& volume = scene.volumes[0];
  EXPECT_EQ(volume.file, file("cloud.vdb"));
  EXPECT_EQ(volume.density, "soot");
  EXPECT_EQ(volume.extinction, 40);
  EXPECT_EQ(volume.extinction_scale, Rgb(1, 2, 3));
  EXPECT_EQ(volume.albedo, Rgb(0.99f, 0.98f, 0.5f));
  EXPECT_EQ(volume.phase.type, PhaseType::two_lobe);
  EXPECT_EQ(volume.phase.g2, -0.3);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].irradiance, Rgb(5, 4, 3));
  EXPECT_EQ(scene.lights[0].angular_radius, 0.27);
  EXPECT_EQ(scene.lights[0].direct, DirectLight::photons);
  EXPECT_EQ(scene.lights[1].type, LightType::environment);
  EXPECT_EQ(scene.lights[1].radiance, Rgb(0.25f));
  EXPECT_FALSE(scene.lights[1].direct.has_value());
  EXPECT_EQ(scene.render.estimator, EstimatorType::march);
  EXPECT_EQ(scene.render.time, 5400);
  EXPECT_EQ(scene.render.photons, 1000000u);
  EXPECT_EQ(scene.render.store, PhotonStore::scatter);
  EXPECT_EQ(scene.render.kernel, KernelRadius::fixed);
  EXPECT_EQ(scene.render.radius, 0.125);
  EXPECT_EQ(scene.render.kernel_shape, KernelShape::epanechnikov);
  EXPECT_EQ(scene.render.max_bounces, 3);
  EXPECT_EQ(scene.render.seed, 9u);
  EXPECT_EQ(scene.render.threads, 2);
  EXPECT_TRUE(scene.notes.empty());
}

TEST_F(SceneFile, InlineListsAreTheSame) {
  const Scene scene = load(R"(
image = { width = 12, height = 34 }
volume = [{ file = "cloud.vdb", phase = "rayleigh" }, { file = "cloud.vdb", extinction = 2 }]
light = [{ type = "point", position = [1, 2, 3], intensity = [4, 5, 6] },
         { type = "spot", direction = [1, 0, 0], cone_angle = 20, cone_falloff = 20 }]
)");
  EXPECT_EQ(scene.image.height, 34);
  ASSERT_EQ(scene.volumes.size(), 2u);
  EXPECT_EQ(scene.volumes[0].phase.type, PhaseType::rayleigh);
  EXPECT_EQ(scene.volumes[1].extinction, 2);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].position, Vec3d(1, 2, 3));
  EXPECT_EQ(scene.lights[1].cone_falloff, 20);
}

TEST_F(SceneFile, DefaultsAreThoseOfTheStructsAndSixtyFourPasses) {
  const Scene scene = load("[[volume]]\nfile = 'cloud.vdb'\n[[light]]\ntype = 'environment'\n");
  EXPECT_EQ(scene.image.width, ImageSettings{}.width);
  EXPECT_EQ(scene.volumes[0].density, "density");
  EXPECT_EQ(scene.render.passes, 64);
  EXPECT_FALSE(scene.render.photons.has_value());
  EXPECT_FALSE(load("render.time = 3").render.passes.has_value());
}

TEST_F(SceneFile, AutomaticValuesCanBeWritten) {
  const Scene scene = load("[render]\nphotons = 'auto'\ndirect_samples = 'auto'\n"
                           "max_bounces = 'none'\ntarget_error = 'none'\npasses = 2\n"
                           "neighbours = 'auto'\n");
  EXPECT_FALSE(scene.render.photons.has_value());
  EXPECT_EQ(scene.render.direct_samples, 0);
  EXPECT_FALSE(scene.render.max_bounces.has_value());
  EXPECT_EQ(scene.render.passes, 2);
}

TEST_F(SceneFile, TimesInEveryNotation) {
  const auto time_of = [&](const std::string& text) {
    return *load("render.time = " + text).render.time;
  };
  EXPECT_EQ(time_of("7"), 7);
  EXPECT_EQ(time_of("0.5"), 0.5);
  EXPECT_EQ(time_of("'60s'"), 60);
  EXPECT_EQ(time_of("'90'"), 90);
  EXPECT_EQ(time_of("'5m'"), 300);
  EXPECT_EQ(time_of("'1.5h'"), 5400);
  EXPECT_EQ(time_of("'1h2m3s'"), 3723);
}

TEST_F(SceneFile, FrameNumbersInPaths) {
  for (const char* pattern : {"s.####.vdb", "s.%04d.vdb", "s.$F4.vdb"}) {
    write("s.0007.vdb", "");
    const Scene scene = load(std::string("[[volume]]\nfile = '") + pattern + "'\n", {}, 7);
    EXPECT_EQ(scene.volumes[0].file, file("s.0007.vdb"));
  }
  for (const char* pattern : {"sky.####.exr", "sky.%04d.exr", "sky.$F4.exr"}) {
    write("sky.0007.exr", "");
    const Scene scene =
        load(std::string("[[light]]\ntype = 'environment'\nimage = '") + pattern + "'\n", {}, 7);
    EXPECT_EQ(scene.lights[0].image, file("sky.0007.exr"));
  }
}

TEST_F(SceneFile, PathsAreRelativeToTheFile) {
  std::filesystem::create_directory(folder_ / "sub");
  write("sub/a.vdb", "");
  const std::string path = write("sub/a.toml", "volume = [{ file = 'a.vdb' }]");
  EXPECT_EQ(load_scene(path).volumes[0].file, file("sub/a.vdb"));
  const std::string absolute = write("b.toml", "volume = [{ file = '" + file("sub/a.vdb") + "' }]");
  EXPECT_EQ(load_scene(absolute).volumes[0].file, file("sub/a.vdb"));
}

TEST_F(SceneFile, PlacementBecomesOneTransform) {
  const Scene scene = load("volume = [{ file = 'cloud.vdb', scale = [2, 3, 4], "
                           "rotate = [90, 0, 90], translate = [10, 20, 30] }]");
  const auto& m = scene.volumes[0].transform;
  // (1, 1, 1) is scaled to (2, 3, 4), turned about X to (2, -4, 3), about Z to (4, 2, 3), moved.
  const Vec3d expected(14, 22, 33);
  for (int row = 0; row < 3; ++row)
    EXPECT_NEAR(m[4 * row] + m[4 * row + 1] + m[4 * row + 2] + m[4 * row + 3], expected[row],
                1e-12);
  const Scene uniform = load("volume = [{ file = 'cloud.vdb', scale = 2 }]");
  EXPECT_EQ(uniform.volumes[0].transform,
            (std::array<double, 12>{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0}));
  const Scene matrix =
      load("volume = [{ file = 'cloud.vdb', transform = [1,0,0,5, 0,1,0,6, 0,0,1,7] }]");
  EXPECT_EQ(matrix.volumes[0].transform,
            (std::array<double, 12>{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7}));
}

TEST_F(SceneFile, RotationAboutY) {
  const Scene scene = load("volume = [{ file = 'cloud.vdb', rotate = [0, 90, 0] }]");
  const auto& m = scene.volumes[0].transform; // X goes to -Z
  EXPECT_NEAR(m[8], -1, 1e-15);
  EXPECT_NEAR(m[2], 1, 1e-15);
}

TEST_F(SceneFile, MissingPartsAreNoted) {
  EXPECT_EQ(load("").notes.size(), 2u);
}

TEST_F(SceneFile, SampleScenesLoad) {
  const Scene cloud = load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml");
  EXPECT_EQ(cloud.volumes.at(0).extinction, 40);
  EXPECT_EQ(cloud.lights.size(), 2u);
  const Scene smoke = load_scene(VDBEAM_SOURCE_DIR "/data/smoke.toml");
  EXPECT_EQ(smoke.camera.up, Vec3d(0, 0, 1));
}

} // namespace
} // namespace vdbeam
