#include "scene/camera_file.h"

#include "scene/scene_fixture.h"

#include <cstring>

namespace vdbeam {
namespace {

class CameraFileTest : public test::SceneTest {
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

TEST_F(CameraFileTest, ChanTurnsAboutZThenXThenY) {
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

TEST_F(CameraFileTest, InterpolatesAndHolds) {
  const std::string text = "10 0 0 0 0 0 0 20\n20 10 0 0 0 90 0 40\n";
  expect_near(camera(text, {13}).position, {3, 0, 0});
  EXPECT_NEAR(camera(text, {13}).fov, 26, 1e-9);
  expect_near(camera(text, {15, 15.5}).position, {5.5, 0, 0});
  const double half = std::sqrt(0.5);
  expect_view(camera(text, {15}), {-half, 0, -half}, {0, 1, 0});
  expect_near(camera(text, {1}).position, {0, 0, 0});
  expect_near(camera(text, {99}).position, {10, 0, 0});
}

/// Frames that the file does not have are reported; a camera that stands still has them all.
TEST_F(CameraFileTest, WarnsOfFramesBeyondTheFile) {
  const auto notes_of = [&](const std::string& text, int frame) {
    write("shot.cam", text);
    std::string notes;
    for (const std::string& note : load(scene_text, {}, {frame}).notes)
      notes += note.find("[[") == std::string::npos ? note + "\n" : ""; // of no volume, no light
    return notes;
  };
  const std::string text = "10 0 0 0 0 0 0 20\n20 10 0 0 0 90 0 40\n";
  EXPECT_NE(
      notes_of(text, 9).find("has the camera from frame 10 to 20; in frame 9 it stands still"),
      std::string::npos);
  EXPECT_NE(notes_of(text, 21).find("in frame 21 it stands still"), std::string::npos);
  EXPECT_EQ(notes_of(text, 10), "");
  EXPECT_EQ(notes_of(text, 20), "");
  EXPECT_EQ(notes_of("1 0 0 0  90 90 0\n", 7), "");
}

TEST_F(CameraFileTest, TheFocalLengthCounts) {
  write("shot.cam", "1 0 0 0  90 90 0\n");
  const auto notes = [&](const std::vector<std::string>& overrides) {
    return testing::PrintToString(load(scene_text, overrides).notes);
  };
  const char* idle = "--set camera.fov=20: camera.fov does nothing beside camera.focal_length";
  EXPECT_NE(notes({"camera.fov=20", "camera.focal_length=50"}).find(idle), std::string::npos);
  EXPECT_EQ(notes({"camera.fov=20"}).find(idle), std::string::npos);
}

/// At (5, 6, 7), turned by 90 degrees about Y: X to -Z, and -Z, where it looks, to -X.
TEST_F(CameraFileTest, MatricesOfBothConventions) {
  const CameraSettings blender =
      camera("[[0, 0, 1, 5], [0, 1, 0, 6], [-1, 0, 0, 7], [0, 0, 0, 1]]");
  expect_near(blender.position, {5, 6, 7});
  expect_view(blender, {-1, 0, 0}, {0, 1, 0});
  const CameraSettings houdini = camera("1  0 0 -1 0  0 1 0 0  1 0 0 0  5 6 7 1\n");
  expect_near(houdini.position, {5, 6, 7});
  expect_view(houdini, {-1, 0, 0}, {0, 1, 0});
}

TEST_F(CameraFileTest, TurnsWorlds) {
  // Blender's exporter writes .chan files with Y up; the volume has Z up.
  const CameraSettings settings =
      camera("1 1 2 3 0 0 0\n", {}, {"camera.file_axes=y_up_to_z_up", "camera.up=[0,0,1]"});
  expect_near(settings.position, {1, -3, 2});
  expect_view(settings, {0, 1, 0}, {0, 0, 1});
  EXPECT_EQ(settings.up, Vec3d(0, 0, 1)); // about which skies turn, whatever the camera does
}

/// Two cameras that hang from a node at (10, 0, 0). The first rises by 24 within a second from its
/// (0, 0, 0) on, and turns by 90 degrees about Y; the second stands still at (1, 2, 3).
const char* gltf_cameras = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"name": "Rig", "translation": [10, 0, 0], "children": [1, 2]},
            {"name": "Crane", "camera": 0}, {"name": "Still", "camera": 1, "translation": [1, 2, 3]}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 1.5, "znear": 0.1}},
              {"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
  "animations": [{"samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 2}],
    "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                 {"sampler": 1, "target": {"node": 1, "path": "rotation"}}]}],
  "buffers": [{"byteLength": 64, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAADAQQAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAPMENT8AAAAA8wQ1Pw=="}],
  "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24},
                  {"buffer": 0, "byteOffset": 32, "byteLength": 32}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR",
                 "min": [0], "max": [1]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC4"}]})";

class GltfCamera : public CameraFileTest {
protected:
  CameraSettings camera(const FrameTime& frame, std::vector<std::string> overrides = {}) {
    write("shot.gltf", gltf_cameras);
    overrides.push_back("camera.file=" + file("shot.gltf"));
    return load("[camera]\n", overrides, frame).camera;
  }
};

TEST_F(GltfCamera, StandsAndTurnsAsItsNodes) {
  const auto expect_close = [](const Vec3d& a, const Vec3d& b) { // the file's are floats
    EXPECT_LT(length(a - b), 1e-5) << a.x << " " << a.y << " " << a.z;
  };
  const CameraSettings first = camera({0}), half = camera({12}), last = camera({24}),
                       later = camera({99});
  expect_close(first.position, {10, 0, 0});
  expect_close(first.look_at - first.position, {0, 0, -1});
  expect_close(half.position, {10, 12, 0});
  const double c = std::sqrt(0.5);
  expect_close(half.look_at - half.position, {-c, 0, -c});
  expect_close(last.position, {10, 24, 0});
  expect_close(last.look_at - last.position, {-1, 0, 0});
  expect_close(*last.picture_up, {0, 1, 0});
  expect_close(later.position, last.position);
  EXPECT_NEAR(first.fov, 0.6 * 180 / M_PI, 1e-4);
  // A quarter of the way in time is a quarter of the turn, though keys are far apart.
  const CameraSettings quarter = camera({6});
  expect_close(quarter.look_at - quarter.position, {-std::sin(M_PI / 8), 0, -std::cos(M_PI / 8)});
  expect_close(camera({12, 12.5}).position, {10, 12.5, 0});
  expect_close(camera({25}, {"camera.file_fps=50"}).position, {10, 12, 0});
}

TEST_F(GltfCamera, ChosenByName) {
  const CameraSettings still = camera({7}, {"camera.name=Still"});
  EXPECT_LT(length(still.position - Vec3d(11, 2, 3)), 1e-5);
  EXPECT_NEAR(still.fov, 0.9 * 180 / M_PI, 1e-4);
  EXPECT_EQ(camera({7}, {"camera.name=Still", "camera.fov=20"}).fov, 20);
}

/// The numbers of an animation may lie in a file of their own:
/// where it alone changes, the camera is read anew, and checkpoints of the scene are of another
/// scene.
TEST_F(GltfCamera, BuffersInOtherFilesArePartOfIt) {
  namespace fs = std::filesystem;
  const auto write_rise = [&](float height) {
    std::vector<float> numbers{0, 1, 0, 0, 0, 0, height, 0, 0, 0, 0, 1, 0, 0, 0, 1};
    std::string bytes(numbers.size() * sizeof(float), 0);
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    write("crane.bin", bytes);
  };
  std::string text = gltf_cameras;
  const std::size_t begin = text.find("data:");
  text.replace(begin, text.find('"', begin) - begin, "crane.bin");
  CameraSettings settings;
  settings.name = "Crane";
  settings.file_fps = 24;
  for (const char* name : {"shot.gltf", "shot.GLTF"}) {
    write_rise(24);
    const std::string path = write(name, text),
                      scene = std::string("[camera]\nfile = '") + name + "'\n";
    settings.file = path;
    CameraFile camera;
    EXPECT_NEAR(camera.pose_at(settings, 24).position.y, 24, 1e-5) << name;
    const std::string hash = pass_hash(load(scene));
    write_rise(36);
    fs::last_write_time(file("crane.bin"), fs::last_write_time(path) + std::chrono::seconds(2));
    EXPECT_NEAR(camera.pose_at(settings, 24).position.y, 36, 1e-5) << name;
    EXPECT_NE(pass_hash(load(scene)), hash) << name;
  }
}

TEST_F(GltfCamera, NamesTheMistake) {
  const auto error = [&](const std::vector<std::string>& overrides) {
    try {
      camera({1}, overrides);
    } catch (const Error& problem) {
      const std::string text = problem.what();
      return text.substr(text.find(": ") + 2);
    }
    return std::string();
  };
  EXPECT_EQ(error({"camera.name=Dolly"}), "holds no camera \"Dolly\", only \"Crane\", \"Still\"");
  write("shot.chan", "1 0 0 0 0 0 0\n");
  EXPECT_EQ(error_of("[camera]\nfile = \"shot.chan\"\nname = \"Crane\"\n"),
            "s.toml:3: camera.name is for cameras of glTF files");
  write("shot.gltf", "{");
  EXPECT_THROW(load("[camera]\nfile = \"shot.gltf\"\n"), FrameError);
}

TEST_F(CameraFileTest, NamesTheMistake) {
  const auto error = [&](const std::string& text) {
    write("shot.cam", text);
    return error_of(scene_text);
  };
  EXPECT_EQ(error("1 2 3\n"), "shot.cam:1: must hold frame, translation, rotation and field of "
                              "view (7 or 8 numbers), or a matrix (16, or 17 with the frame), got "
                              "3 numbers");
  EXPECT_EQ(error("\n1 0 0 x 0 0 0\n"), "shot.cam:2: must hold finite numbers and nothing else");
  EXPECT_EQ(error("2 0 0 0 0 0 0\n2 0 0 0 0 0 0\n"),
            "shot.cam:2: must have a greater frame number than the line before");
  EXPECT_EQ(error("1 0 0 0 0 0 0 200\n"),
            "shot.cam:1: must have a field of view in (0, 180) degrees, got 200");
  EXPECT_EQ(error("-1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n"),
            "shot.cam:1: must be a rotation (with scales above 0), neither mirrored nor flat");
  EXPECT_EQ(error("# nothing\n"), "shot.cam: holds no camera");
  // A file that is no camera is not quoted, nor read for ever.
  EXPECT_EQ(error("root:secret:19000\n"), "shot.cam:1: must hold finite numbers and nothing else");
  EXPECT_EQ(error("1 0 0 1e999 0 0 0\n"), "shot.cam:1: must hold finite numbers and nothing else");
  EXPECT_EQ(error("1 0 0 1e-310 0 0 0\n"), "");
  EXPECT_EQ(error(std::string(100'000, '0')), "shot.cam:1: must have lines of at most 64 KiB");
  std::filesystem::resize_file(file("shot.cam"), std::uintmax_t(20) << 30);
  EXPECT_NE(error_of(scene_text).find("shot.cam: has 20.0 GiB, more than the 64 MiB"),
            std::string::npos);
  write("shot.cam", "1 0 0 0 0 0 0\n");
  EXPECT_EQ(error_of("[camera]\nfile = \"shot.cam\"\nposition = [0, 0, 1]\n"),
            "s.toml:3: camera.position excludes camera.file, which places the camera");
}

/// The moments of a shutter and the frames of a sequence ask for it again and again.
TEST_F(CameraFileTest, IsReadAgainOnlyWhereItChanged) {
  namespace fs = std::filesystem;
  const auto text = [](int x) { return "1 " + std::to_string(x) + " 0 0 0 0 0\n"; };
  CameraSettings settings;
  settings.file = write("shot.chan", text(1));
  const fs::file_time_type written = fs::last_write_time(settings.file);
  CameraFile camera;
  EXPECT_EQ(camera.pose_at(settings, 1).position.x, 1);
  write("shot.chan", text(2));
  fs::last_write_time(settings.file, written); // as if nobody had written
  EXPECT_EQ(camera.pose_at(settings, 2).position.x, 1);
  fs::last_write_time(settings.file, written + std::chrono::seconds(2));
  EXPECT_EQ(camera.pose_at(settings, 1).position.x, 2);
  settings.file = write("other.chan", text(3));
  EXPECT_EQ(camera.pose_at(settings, 1).position.x, 3);
}

TEST_F(CameraFileTest, LensesAreChecked) {
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
