#include "render/shutter.h"

#include "support/ball_scene.h"
#include "support/render_parts.h"

#include <cstring>
#include <set>

namespace vdbeam {
namespace {

/// The ball, seen by parallel rays while the shutter is open.
class ShutterTest : public test::BallTest {
protected:
  Scene load(const std::vector<std::string>& more = {}, const std::string& camera = "") {
    return load_ball(parallel_rays + camera, more);
  }
  static void expect_same(const Image& a, const Image& b) {
    for (const char* name : {"R", "A", "depth.Z"})
      EXPECT_EQ(std::memcmp(plane(a, name).data(), plane(b, name).data(),
                            plane(a, name).size() * sizeof(float)),
                0);
  }
};

TEST_F(ShutterTest, PassesVisitEveryMomentOnce) {
  for (const std::uint64_t seed : {1, 2, 99})
    for (const int moments : {1, 16, 64}) {
      std::set<std::size_t> seen;
      for (int pass = 0; pass < moments; ++pass)
        seen.insert(motion_sample(pass, static_cast<std::size_t>(moments), seed));
      EXPECT_EQ(seen.size(), static_cast<std::size_t>(moments));
      if (moments == 1)
        continue;
      std::vector<int> halves(2);
      for (int pass = 0; pass < 8; ++pass)
        ++halves[2 * motion_sample(pass, static_cast<std::size_t>(moments), seed) /
                 static_cast<std::size_t>(moments)];
      EXPECT_LE(std::abs(halves[0] - halves[1]), 2);
    }
}

/// Without time, nothing is blurred: the bits are those of a camera without a shutter.
TEST_F(ShutterTest, NoTimeNoBlur) {
  const Scene still = load({"volume.0.velocity=none"});
  const Scene closed = load({"camera.shutter_open=0.3", "camera.shutter_close=0.3"});
  EXPECT_TRUE(closed.moments.empty());
  expect_same(render(still).image, render(closed).image);
  const Scene nothing_moves = load({"camera.shutter_close=1", "volume.0.velocity=none"});
  EXPECT_TRUE(nothing_moves.moments.empty());
}

/// A time limit may end a frame before its passes have seen the whole of the shutter's time.
TEST_F(ShutterTest, WarnsOfTooFewPasses) {
  const auto notes_of = [&](const std::string& passes) {
    std::string all;
    for (const std::string& note :
         render(load({"camera.shutter_close=1", "render.passes=" + passes})).notes)
      all += note + "\n";
    return all;
  };
  EXPECT_NE(notes_of("5").find("motion blur has 5 motion samples only"), std::string::npos);
  EXPECT_EQ(notes_of("16").find("open shutter"), std::string::npos);
}

/// Volumes that stay sharp under an open shutter get a note.
TEST_F(ShutterTest, WarnsOfMissingVelocities) {
  const auto notes_of = [&](const std::vector<std::string>& more) {
    std::string all;
    for (const std::string& note : render(load(more)).notes)
      all += note + "\n";
    return all;
  };
  EXPECT_EQ(notes_of({"camera.shutter_close=0.5"}).find("velocities"), std::string::npos);
  write("noise", "ball.vdb");
  EXPECT_NE(notes_of({"camera.shutter_close=0.5"}).find("has no velocity grid"), std::string::npos);
  EXPECT_EQ(notes_of({}).find("velocities"), std::string::npos);
  EXPECT_EQ(notes_of({"camera.shutter_close=0.5", "volume.0.velocity=none"}).find("velocities"),
            std::string::npos);
}

/// The blurred picture is the mean of the pictures at the moments: each pass is that of the scene
/// with the volume moved. Optical depths are small, so opacity adds up to the mass of the ball, and
/// its centre shows how far it came.
TEST_F(ShutterTest, MovesABallByItsVelocity) {
  const auto centre = [](const Image& image, double& mass) {
    Vec3d sum;
    mass = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        const double a = plane(image, "A")[static_cast<std::size_t>(y * 24 + x)];
        // 4 pixels per unit, the first 3 units to the left of and above the middle
        sum += Vec3d((x + 0.5) / 4 - 3, 3 - (y + 0.5) / 4, 0) * a;
        mass += a;
      }
    return sum / mass;
  };
  double still_mass = 0, mass = 0;
  const std::vector<std::string> thin{"volume.0.extinction=0.01", "render.passes=64"};
  std::vector<std::string> open = thin;
  open.insert(open.end(), {"camera.shutter_open=0.2", "camera.shutter_close=0.6"});
  const Vec3d start = centre(render(load(thin)).image, still_mass);
  const Vec3d end = centre(render(load(open)).image, mass);
  EXPECT_NEAR(mass, still_mass, 0.01 * still_mass);
  EXPECT_NEAR(end.x - start.x, 0.4, 0.01); // the middle of the shutter is at 0.4
  EXPECT_NEAR(end.y - start.y, 0.8, 0.01);
}

/// Pass for pass the blurred picture is that of a shutter that is open for an instant at the pass'
/// moment.
TEST_F(ShutterTest, BlurIsTheMeanOfItsMoments) {
  const Scene scene = load({"camera.shutter_open=-0.2", "camera.shutter_close=0.6"});
  const Image blurred = render(scene).image;
  std::vector<double> sum(plane(blurred, "A").size());
  for (int pass = 0; pass < 16; ++pass) {
    const std::size_t moment = motion_sample(pass, scene.moments.size(), 1);
    const double time = scene.moments[moment].volumes[0].velocity.time; // 1 frame per second
    Scene instant =
        load({"camera.shutter_open=" + std::to_string(time - 1e-4),
              "camera.shutter_close=" + std::to_string(time + 1e-4), "camera.shutter_times=1"});
    FrameSettings frame;
    frame.pass_range = PassRange{pass, pass};
    const Image image = render(instant, frame).image;
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += static_cast<double>(plane(image, "A")[i]) / 16;
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    EXPECT_NEAR(sum[i], plane(blurred, "A")[i], 1e-4) << i;
}

/// A camera that moves and a ball that moves as it does make a still picture but for the sampling.
TEST_F(ShutterTest, CamerasMoveToo) {
  const std::vector<std::string> base{"render.passes=64"};
  const Image still = render(load(base)).image;
  std::vector<std::string> follow = base;
  follow.push_back("camera.shutter_close=0.5");
  const std::string keys = "shutter_close = 0.5\nup = [0, 1, 0]\n";
  Scene scene = load(base, keys);
  for (Scene& moment : scene.moments) {
    // Where the world is seen at this time: cameras move in finer steps, to the same mean.
    const double time = moment.volumes[0].velocity.time;
    moment.camera.position = Vec3d(0, 0, 6) + Vec3d(1, 2, 3) * time;
    moment.camera.look_at = Vec3d(1, 2, 3) * time;
  }
  const Image moving = render(scene).image;
  double difference = 0, total = 0;
  for (std::size_t i = 0; i < plane(still, "A").size(); ++i) {
    difference += std::abs(static_cast<double>(plane(still, "A")[i] - plane(moving, "A")[i]));
    total += plane(still, "A")[i];
  }
  EXPECT_LT(difference, 0.03 * total);
}

/// All estimators see the same blur.
TEST_F(ShutterTest, SlowEstimatorsAgree) {
  const std::vector<std::string> base{"camera.shutter_close=0.5", "render.passes=32",
                                      "volume.0.extinction=2",    "volume.0.albedo=0.8",
                                      "render.photons=20000",     "render.kernel=fixed",
                                      "render.radius=0.1"};
  const auto mean_of = [&](const char* estimator) {
    std::vector<std::string> more = base;
    more.push_back(std::string("render.estimator=") + estimator);
    const Image image = render(load(more)).image;
    double sum = 0;
    for (const float value : plane(image, "R"))
      sum += static_cast<double>(value);
    return sum / static_cast<double>(plane(image, "R").size());
  };
  const double path = mean_of("path");
  EXPECT_NEAR(mean_of("beam"), path, 0.02 * path);
  EXPECT_NEAR(mean_of("march"), path, 0.02 * path);
}

/// Passes are functions of their number: parts of a blurred frame merge to the bits of the whole.
TEST_F(ShutterTest, PartsMergeToTheWhole) {
  const Scene scene = load({"camera.shutter_close=0.5", "render.estimator=beam", "render.passes=6",
                            "render.photons=2000"});
  const Image whole = render(scene).image;
  expect_same(merge_partials(test::render_parts(scene, folder_, {{2, 5}, {0, 1}})), whole);
}

/// The same where the camera moves fast: what is planned about photons depends on no pass.
TEST_F(ShutterTest, PartsOfAMovingCameraMergeToTheWhole) {
  for (const char* velocity : {"auto", "none"}) {
    const Scene scene = load({"render.estimator=beam", "render.passes=6", "render.thinning=view",
                              std::string("volume.0.velocity=") + velocity},
                             "shutter_close = 1\n"
                             "look_at = { keys = [[1, [0, 0, 0]], [2, [6, 0, 0]]] }\n");
    ASSERT_FALSE(scene.moments.empty());
    const Image whole = render(scene).image;
    expect_same(merge_partials(test::render_parts(scene, folder_, {{3, 5}, {0, 2}})), whole);
  }
}

/// What is found out about photons before the first pass is found out once, whatever the moments:
/// in all, and for each group of lights.
TEST_F(ShutterTest, PhotonsArePlannedOnceForAllMoments) {
  for (const bool grouped : {false, true}) {
    const auto render_it = [&](bool open) {
      std::vector<std::string> more{"render.estimator=beam", "render.thinning=view",
                                    "volume.0.extinction=4", "light.1.type=distant",
                                    "light.1.direction=[1,-1,0]"};
      if (grouped)
        more.insert(more.end(), {"light.0.group=sky", "light.1.group=sun"});
      if (open)
        more.push_back("camera.shutter_close=0.5");
      return render(load(more));
    };
    const RenderResult still = render_it(false), blurred = render_it(true);
    EXPECT_GT(still.statistics.pilot_paths, 0u);
    EXPECT_EQ(blurred.statistics.pilot_paths, still.statistics.pilot_paths);
  }
}

/// Light paths that follow the plan of their group bring the light of that group.
TEST_F(ShutterTest, GroupsOfABlurredFrameAddUpToThePicture) {
  const Scene scene =
      load({"render.estimator=beam", "render.thinning=view", "volume.0.extinction=4",
            "light.1.type=distant", "light.1.direction=[1,-1,0]", "light.0.group=sky",
            "camera.shutter_close=0.5"});
  const Image whole = render(scene).image;
  const auto sum_of = [&](const char* name) {
    double sum = 0;
    for (const float value : plane(whole, name))
      sum += static_cast<double>(value);
    return sum;
  };
  EXPECT_GT(sum_of("light_sky.R"), 0);
  EXPECT_GT(sum_of("light_rest.R"), 0);
  EXPECT_NEAR(sum_of("light_sky.R") + sum_of("light_rest.R"), sum_of("R"), 1e-4 * sum_of("R"));
  expect_same(merge_partials(test::render_parts(scene, folder_, {{9, 15}, {0, 8}})), whole);
}

TEST_F(ShutterTest, TheHashKnowsWhatMoves) {
  const std::string a = scene_hash(load({"camera.shutter_close=0.5"}));
  const std::string keys = "shutter_close = 0.5\n";
  const std::string b = scene_hash(load({}, keys + "fov = { keys = [[1, 30], [2, 60]] }\n"));
  const std::string c = scene_hash(load({}, keys + "fov = { keys = [[1, 30], [2, 61]] }\n"));
  EXPECT_NE(a, b);
  EXPECT_NE(b, c);
}

} // namespace
} // namespace vdbeam
