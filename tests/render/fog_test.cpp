// Volumes without a file from the scene file to the picture.
#include "medium/medium.h"
#include "prepare/prepared_scene.h"
#include "support/image_checks.h"
#include "support/read_deep.h"
#include "support/temp_folder.h"
#include "vdbeam/memory_plan.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

using test::plane;

class FogPicture : public ::testing::Test {
protected:
  Scene load(const std::string& volume, const std::vector<std::string>& more = {},
             const FrameTime& frame = 1) const {
    test::write_bytes(folder_.file("s.toml"),
                      "[image]\nwidth = 12\nheight = 8\n[camera]\nposition = [0, 0.5, 8]\n"
                      "look_at = [0, 0.2, 0]\nfov = 25\n" +
                          volume +
                          "[[light]]\ntype = 'distant'\ndirection = [-1, -1, -1]\n"
                          "[[light]]\ntype = 'environment'\nradiance = 0.3\n"
                          "[render]\nphotons = 3000\npasses = 2\n");
    return load_scene(folder_.file("s.toml"), frame, more);
  }

  test::TempFolder folder_;
};

constexpr const char* shapes[] = {
    "[[volume]]\nshape = 'box'\nextinction = 0.7\nrotate = [0, 30, 0]\nname = 'fog'\n",
    "[[volume]]\nshape = 'sphere'\nextinction = 2\nname = 'fog'\n",
    "[[volume]]\nshape = 'height'\nscale_height = 0.5\nextinction = 2\nnoise_amplitude = 0.2\n"
    "name = 'fog'\n"};

/// Deep samples laid over each other are the flat layer, and alpha lies between nothing and all.
TEST_F(FogPicture, HasEveryLayer) {
  for (const char* shape : shapes)
    for (const char* estimator : {"beam", "gather", "path", "march"}) {
      SCOPED_TRACE(std::string(shape) + estimator);
      const RenderResult result = render(
          load(shape, {"image.deep=true", "image.cryptomatte=true",
                       std::string("render.estimator=") + estimator, "light.1.visible=false"}));
      ASSERT_TRUE(result.deep);
      const auto flat = result.deep->flatten();
      const std::vector<float>& alpha = plane(result.image, "volume.A");
      const std::vector<float>& red = plane(result.image, "volume.R");
      float most = 0, least = 1;
      for (std::size_t i = 0; i < flat.size(); ++i) {
        ASSERT_NEAR(flat[i][0], red[i], 2e-4 * std::abs(red[i]) + 2e-6);
        ASSERT_NEAR(flat[i][3], alpha[i], 2e-4);
        most = std::max(most, alpha[i]);
        least = std::min(least, alpha[i]);
      }
      EXPECT_GT(most, 0.5f);
      EXPECT_GE(least, 0);
      EXPECT_LE(most, 1);
    }
}

/// A shape that glows by its density, seen along an axis: closed forms, with and without
/// absorption.
TEST_F(FogPicture, GlowsByItsDensity) {
  struct Case {
    const char* keys;
    double integral; ///< of the density along the line of sight
    bool uniform;    ///< the same density everywhere
  };
  for (const Case& one : {Case{"shape = 'box'\n", 2, true}, Case{"shape = 'sphere'\n", 2, true},
                          Case{"shape = 'height'\nscale_height = 0.5\nrotate = [90, 0, 0]\n",
                               0.5 * (1 - std::exp(-4.0)), false}})
    for (const double sigma : {0.0, 1.5})
      for (const char* estimator : {"path", "beam", "gather", "march"}) {
        if (sigma > 0 && !one.uniform)
          continue;
        SCOPED_TRACE(std::string(one.keys) + estimator);
        const std::string volume =
            std::string("[[volume]]\n") + one.keys +
            "albedo = 0\nextinction = " + std::to_string(sigma) +
            "\nemission = { intensity = 'density', color = [1, 0.5, 0], scale = 3 }\n";
        const RenderResult result = render(
            load(volume, {std::string("render.estimator=") + estimator,
                          "camera.position=[0, 0, 400]", "camera.look_at=[0, 0, 0]",
                          "camera.fov=0.001", "light.0.irradiance=0", "light.1.radiance=0"}));
        const double light =
            sigma > 0 ? 3 / sigma * (1 - std::exp(-sigma * one.integral)) : 3 * one.integral;
        // A sphere's faces rise over a voxel.
        for (const float value : plane(result.image, "R"))
          EXPECT_NEAR(value, light, 0.01 * light);
        for (const float value : plane(result.image, "G"))
          EXPECT_NEAR(value, light / 2, 0.005 * light);
      }
}

/// A frame that takes over from the one before is that of a render by itself.
TEST_F(FogPicture, OfASequenceIsThatOfAFrame) {
  const std::string fog = "[[volume]]\nshape = 'height'\nextinction = 2\nscale_height = { keys = "
                          "[[1, 0.2], [3, 0.6]] }\n";
  PreparedScenePtr previous;
  for (const int frame : {1, 2, 2, 3}) {
    const Scene scene = load(fog, {"render.estimator=path"}, frame);
    const PreparedScenePtr prepared = prepare_scene(scene, previous);
    const RenderResult sequence = render(scene, prepared), alone = render(scene);
    EXPECT_EQ(plane(sequence.image, "R"), plane(alone.image, "R")) << frame;
    previous = prepared;
  }
}

/// An open shutter sees a fog whose height changes.
TEST_F(FogPicture, IsBlurredByItsOwnMotion) {
  const std::string fog = "[[volume]]\nshape = 'box'\nextinction = 2\nbox_lower = [-1, -1, -1]\n"
                          "box_upper = { keys = [[1, [1, 0, 1]], [2, [1, 1, 1]]] }\n";
  const std::vector<std::string> path{"render.estimator=path", "light.1.visible=false"};
  std::vector<std::string> open = path;
  open.insert(open.end(), {"camera.shutter_close=1", "render.passes=32"});
  const auto mean_alpha = [&](const RenderResult& result) {
    double sum = 0;
    for (const float a : plane(result.image, "A"))
      sum += static_cast<double>(a);
    return sum;
  };
  const double first = mean_alpha(render(load(fog, path, 1))),
               last = mean_alpha(render(load(fog, path, 2))),
               blurred = mean_alpha(render(load(fog, open, 1)));
  EXPECT_GT(last, first * 1.1);
  EXPECT_GT(blurred, first * 1.02);
  EXPECT_LT(blurred, last * 0.98);
}

TEST_F(FogPicture, PlanKnowsItsMemoryAndReadsNothing) {
  for (const char* shape : shapes) {
    const Scene scene = load(shape);
    const RenderPlan plan = make_plan(scene);
    EXPECT_FALSE(plan.needs(Stage::read));
    EXPECT_TRUE(plan.needs(Stage::photons));
    const MemoryPlan memory = plan_memory(scene);
    const auto bytes = static_cast<double>(prepare_scene(scene)->world->medium.bytes());
    for (const PlannedMemory& part : memory.parts)
      if (part.name == "volumes") {
        EXPECT_GE(static_cast<double>(part.rendering), 0.5 * bytes);
        EXPECT_LE(static_cast<double>(part.rendering), 2 * bytes + (1 << 20));
      }
  }
}

} // namespace
} // namespace vdbeam
