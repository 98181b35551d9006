#include "scene/scene_fixture.h"

namespace vdbeam {
namespace {

class CameraFile : public test::SceneTest {
protected:
  static constexpr const char* scene_text = "[camera]\nfile = \"shot.cam\"\n";

  CameraSettings camera(const std::string& text, const FrameTime& frame = {},
                        const std::vector<std::string>& overrides = {}) {
    write("shot.cam", text);
    return load(scene_text, overrides, frame).camera;
  }
  static void expect_near(const Vec3d& a, const Vec3d& b) {
    EXPECT_LT(length(a - b), 1e-9) << a.x << " " << a.y << " " << a.z;
  }
  static void expect_view(const CameraSettings& camera, const Vec3d& forward, const Vec3d& up) {
    expect_near(camera.look_at - camera.position, forward);
    ASSERT_TRUE(camera.picture_up.has_value());
    expect_near(*camera.picture_up, up);
  }
};

TEST_F(CameraFile, ChanTurnsAboutZThenXThenY) {
  // A camera that looks along -Z, turned by 90 degrees about X looks up, and then by 90 about Y to
  // where its top was: the back, +Z, goes to +X.
  const CameraSettings settings = camera("# frame t r fov\n1 1 2 3  90 90 0  40\n");
  expect_near(settings.position, {1, 2, 3});
  expect_view(settings, {0, 1, 0}, {1, 0, 0});
  EXPECT_EQ(settings.fov, 40);
  expect_view(camera("1 0 0 0  90 90 0\n", {}, {"camera.file_rotation=yxz"}), {-1, 0, 0},
              {0, 0, 1});
  EXPECT_EQ(camera("1 0 0 0  90 90 0\n").fov, 30);
}

TEST_F(CameraFile, InterpolatesAndHolds) {
  const std::string text = "10 0 0 0 0 0 0 20\n20 10 0 0 0 90 0 40\n";
  expect_near(camera(text, {13}).position, {3, 0, 0});
  EXPECT_NEAR(camera(text, {13}).fov, 26, 1e-9);
  expect_near(camera(text, {15, 15.5}).position, {5.5, 0, 0});
  const double half = std::sqrt(0.5);
  expect_view(camera(text, {15}), {-half, 0, -half}, {0, 1, 0});
  expect_near(camera(text, {1}).position, {0, 0, 0});
  expect_near(camera(text, {99}).position, {10, 0, 0});
}

/// At (5, 6, 7), turned by 90 degrees about Y: X to -Z, and -Z, where it looks, to -X.
TEST_F(CameraFile, MatricesOfBothConventions) {
  const CameraSettings blender =
      camera("[[0, 0, 1, 5], [0, 1, 0, 6], [-1, 0, 0, 7], [0, 0, 0, 1]]");
  expect_near(blender.position, {5, 6, 7});
  expect_view(blender, {-1, 0, 0}, {0, 1, 0});
  const CameraSettings houdini = camera("1  0 0 -1 0  0 1 0 0  1 0 0 0  5 6 7 1\n");
  expect_near(houdini.position, {5, 6, 7});
  expect_view(houdini, {-1, 0, 0}, {0, 1, 0});
}

TEST_F(CameraFile, TurnsWorlds) {
  // Blender's exporter writes .chan files with Y up; the volume has Z up.
  const CameraSettings settings =
      camera("1 1 2 3 0 0 0\n", {}, {"camera.file_axes=y_up_to_z_up", "camera.up=[0,0,1]"});
  expect_near(settings.position, {1, -3, 2});
  expect_view(settings, {0, 1, 0}, {0, 0, 1});
  EXPECT_EQ(settings.up, Vec3d(0, 0, 1)); // about which skies turn, whatever the camera does
}

TEST_F(CameraFile, TellsWhatIsWrong) {
  const auto error = [&](const std::string& text) {
    write("shot.cam", text);
    return error_of(scene_text);
  };
  EXPECT_EQ(error("1 2 3\n"), "shot.cam:1: must hold frame, translation, rotation and field of "
                              "view (7 or 8 numbers), or a matrix (16, or 17 with the frame), got "
                              "3 numbers");
  EXPECT_EQ(error("\n1 0 0 x 0 0 0\n"), "shot.cam:2: must hold numbers, got x");
  EXPECT_EQ(error("2 0 0 0 0 0 0\n2 0 0 0 0 0 0\n"),
            "shot.cam:2: must have a greater frame number than the line before");
  EXPECT_EQ(error("1 0 0 0 0 0 0 200\n"),
            "shot.cam:1: must have a field of view in (0, 180) degrees, got 200");
  EXPECT_EQ(error("-1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n"),
            "shot.cam:1: must be a rotation (with scales above 0), neither mirrored nor flat");
  EXPECT_EQ(error("# nothing\n"), "shot.cam: holds no camera");
  write("shot.cam", "1 0 0 0 0 0 0\n");
  EXPECT_EQ(error_of("[camera]\nfile = \"shot.cam\"\nposition = [0, 0, 1]\n"),
            "s.toml:3: camera.position excludes camera.file, which says where the camera is");
}

TEST_F(CameraFile, LensesAreChecked) {
  EXPECT_EQ(error_of("[camera]\nprojection = \"orthographic\"\n"),
            "s.toml:2: camera.projection is \"orthographic\": camera.view_height is needed too");
  EXPECT_EQ(error_of("[camera]\nf_stop = 2\n"),
            "s.toml:2: camera.f_stop needs camera.focal_length, or write camera.lens_radius");
  EXPECT_EQ(error_of("[camera]\nnear = 2\nfar = 1\n"),
            "s.toml:3: camera.far must be greater than camera.near (2), got 1");
  EXPECT_EQ(error_of("[camera]\nblades = 2\n"),
            "s.toml:2: camera.blades must be 0 or at least 3, got 2");
  EXPECT_EQ(error_of("[camera]\nprojection = \"panorama\"\nlens_radius = 1\n"),
            "s.toml:3: camera.lens_radius needs camera.projection = \"perspective\"");
}

} // namespace
} // namespace vdbeam
