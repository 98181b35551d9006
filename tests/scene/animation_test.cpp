#include "scene/volume_time.h"
#include "scene_fixture.h"

#include <cmath>

namespace vdbeam {
namespace {

using Animation = test::SceneTest;

std::string scene_with(const std::string& volume, const std::string& rest = "") {
  return "[[volume]]\nfile = 'cloud.vdb'\n" + volume + "\n" + rest;
}

TEST_F(Animation, LinearKeysHoldOutsideAndInterpolateInside) {
  const std::string text = scene_with("extinction = { keys = [[1, 10], [5, 30], [7, 0]] }");
  const auto at = [&](int frame) { return load(text, {}, frame).volumes[0].extinction; };
  EXPECT_DOUBLE_EQ(at(-3), 10);
  EXPECT_DOUBLE_EQ(at(1), 10);
  EXPECT_DOUBLE_EQ(at(2), 15);
  EXPECT_DOUBLE_EQ(at(5), 30);
  EXPECT_DOUBLE_EQ(at(6), 15);
  EXPECT_DOUBLE_EQ(at(99), 0);
}

/// An open shutter sees a frame at other times than its own.
TEST_F(Animation, AFrameIsEvaluatedAtAnyOfItsTimes) {
  write("s.0002.vdb", " BDV two");
  const std::string text = "[[volume]]\nfile = 's.####.vdb'\n"
                           "extinction = { keys = [[1, 10], [5, 30]] }\n";
  const Scene scene = load(text, {}, {2, 2.75});
  EXPECT_DOUBLE_EQ(scene.volumes[0].extinction, 18.75);
  EXPECT_EQ(scene.volumes[0].file, file("s.0002.vdb"));
  EXPECT_EQ(scene.frame.number, 2);
  EXPECT_EQ(scene.frame.time, 2.75);
  EXPECT_EQ(load(text, {}, 2).frame.time, 2);
}

TEST_F(Animation, SmoothCurvesMeetTheirKeysWithoutOvershoot) {
  const std::string text = scene_with(
      "", "[camera]\nposition = { keys = [[0, [0, 1, 5]], [10, [0, 2, 5]], [40, [8, 2, 5]]], "
          "interpolation = 'smooth' }");
  const auto at = [&](int frame) { return load(text, {}, frame).camera.position; };
  EXPECT_DOUBLE_EQ(at(10).y, 2);
  EXPECT_DOUBLE_EQ(at(10).x, 0);
  EXPECT_DOUBLE_EQ(at(5).y, 1.5); // between two flat ends, half way
  EXPECT_LT(at(1).y - 1, 0.1);    // it starts slowly
  for (int frame = 0; frame <= 41; ++frame) {
    EXPECT_LE(at(frame).x, at(frame + 1).x);
    EXPECT_LE(at(frame).y, 2);
  }
}

TEST_F(Animation, SmoothSlopesAreContinuous) {
  const std::string text = scene_with("extinction = { keys = [[0, 0], [1000, 100], [3000, 500]], "
                                      "interpolation = 'smooth' }");
  const auto at = [&](int frame) { return load(text, {}, frame).volumes[0].extinction; };
  const double before = at(1000) - at(999), after = at(1001) - at(1000);
  EXPECT_GT(before, 0.05);
  EXPECT_NEAR(before, after, 0.002);
}

/// Photons that do not depend on the view can serve all frames where nothing but the camera moves.
TEST_F(Animation, ThinningFollowsWhatMoves) {
  const std::string moving = "[camera]\nfov = { keys = [[1, 30], [9, 40]] }\n";
  const auto thinning = [&](const std::string& text) { return load(text).render.thinning; };
  EXPECT_EQ(thinning(scene_with("")), PhotonThinning::automatic);
  EXPECT_EQ(thinning(scene_with("", moving)), PhotonThinning::even);
  EXPECT_EQ(thinning(scene_with("extinction = { keys = [[1, 10], [5, 30]] }", moving)),
            PhotonThinning::automatic);
  EXPECT_EQ(thinning(scene_with("", moving + "[render]\nthinning = 'view'\n")),
            PhotonThinning::view);
}

TEST_F(Animation, WholeNumbersColoursAndPlacementsCanBeAnimated) {
  const Scene scene = load(scene_with("translate = { keys = [[0, [0, 0, 0]], [2, [4, 0, 0]]] }\n"
                                      "albedo = { keys = [[0, 0], [2, [1, 0.5, 0]]] }",
                                      "[render]\nseed = { keys = [[0, 1], [4, 9]] }"),
                           {}, 1);
  EXPECT_DOUBLE_EQ(scene.volumes[0].transform[3], 2);
  EXPECT_FLOAT_EQ(scene.volumes[0].albedo.x, 0.5f);
  EXPECT_FLOAT_EQ(scene.volumes[0].albedo.y, 0.25f);
  EXPECT_EQ(scene.render.seed, 3u);
}

TEST_F(Animation, MistakesAreToldWithTheirLine) {
  const auto error = [&](const std::string& value) {
    return error_of(scene_with("albedo = " + value));
  };
  EXPECT_NE(error("{ keys = [[1, 0.5], [2, 1.5]] }").find("s.toml:3: volume.0.albedo must lie in"),
            std::string::npos);
  EXPECT_NE(error("{ keys = [[2, 0.5], [1, 1]] }").find("order"), std::string::npos);
  EXPECT_NE(error("{ keys = [] }").find("needs a list of keys"), std::string::npos);
  EXPECT_NE(error("{ keys = [[1]] }").find("[frame, value]"), std::string::npos);
  EXPECT_NE(error("{ keys = [[1, 1]], interpolation = 'cubic' }").find("linear or smooth"),
            std::string::npos);
  EXPECT_NE(error("{ key = [[1, 1]] }").find("unknown entry key"), std::string::npos);
  EXPECT_NE(error_of(scene_with("density = { keys = [[1, 'a']] }")).find("must be a text"),
            std::string::npos);
}

TEST_F(Animation, TimeChoosesTheFile) {
  for (const char* name : {"s.0001.vdb", "s.0002.vdb", "s.0003.vdb", "s.0004.vdb"})
    write(name, name);
  const auto file_at = [&](const std::string& time, int frame) {
    const Scene scene =
        load("[[volume]]\nfile = 's.####.vdb'\ntime = { " + time + " }\n", {}, frame);
    const std::string& path = scene.volumes[0].file;
    return scene.volumes[0].present ? path.substr(path.size() - 8, 4) : std::string("none");
  };
  EXPECT_EQ(file_at("offset = 2", 1), "0003");
  EXPECT_EQ(file_at("speed = 0.5", 6), "0003");
  EXPECT_EQ(file_at("speed = -1, offset = 5", 2), "0003");
  EXPECT_EQ(file_at("", 9), "0004");
  EXPECT_EQ(file_at("out_of_range = 'clip'", 9), "none");
  EXPECT_EQ(file_at("out_of_range = 'clip'", 4), "0004");
  EXPECT_EQ(file_at("out_of_range = 'repeat'", 5), "0001");
  EXPECT_EQ(file_at("out_of_range = 'repeat'", -1), "0003");
  EXPECT_EQ(file_at("out_of_range = 'ping-pong'", 5), "0003");
  EXPECT_EQ(file_at("out_of_range = 'ping-pong'", 8), "0002");
  EXPECT_EQ(file_at("out_of_range = 'ping-pong'", 0), "0002");
  EXPECT_NE(error_of("[[volume]]\nfile = 's.####.vdb'\ntime = { out_of_range = 'loop' }\n")
                .find("clip, hold, repeat or ping-pong"),
            std::string::npos);
  EXPECT_NE(error_of("[[volume]]\nfile = 's.####.vdb'\ntime = { sped = 2 }\n")
                .find("unknown key volume.0.time.sped"),
            std::string::npos);
}

TEST_F(Animation, AClippedVolumeChangesTheHash) {
  write("s.0001.vdb", " BDV one");
  const std::string text =
      "[[volume]]\nfile = 's.####.vdb'\ntime = { out_of_range = 'clip' }\n[[light]]\ntype = "
      "'environment'\n";
  EXPECT_NE(scene_hash(load(text, {}, 1)), scene_hash(load(text, {}, 2)));
  EXPECT_EQ(scene_hash(load(text, {}, 2)), scene_hash(load(text, {}, 3)));
}

TEST_F(Animation, PassHashForgetsTheStopRuleOnly) {
  const std::string text = scene_with("");
  const auto hash = [&](const std::string& entry) { return pass_hash(load(text, {entry})); };
  EXPECT_EQ(hash("render.passes=3"), hash("render.time=7"));
  EXPECT_EQ(hash("render.passes=3"), hash("render.target_error=0.1"));
  EXPECT_NE(hash("render.passes=3"), hash("render.seed=7"));
  EXPECT_NE(scene_hash(load(text, {"render.passes=3"})),
            scene_hash(load(text, {"render.passes=4"})));
}

} // namespace
} // namespace vdbeam
