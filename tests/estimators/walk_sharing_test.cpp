// What pixels share of their walks: a fitted plane, and nothing with what lies at another depth.
#include "estimators/gather/regression.h"

#include "choose/pilot/gather_plan.h"
#include "estimators/beam/beam.h"
#include "math/pixel_fit.h"
#include "render/pass_window.h"
#include "support/render_passes.h"
#include "tuning/constants.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>

namespace vdbeam {
namespace {

using namespace test;

constexpr int width = 9;

/// A square of pixels before a camera at a distance of about 5.
struct Square {
  std::vector<float> opacity = std::vector<float>(width * width, 0.5f);
  std::vector<float> distance = std::vector<float>(width * width, 5);
  std::vector<float> depth;
  Camera camera;

  Square() : camera(settings(), image(), {}) {}
  static CameraSettings settings() {
    CameraSettings settings;
    settings.position = {0, 0, 5};
    settings.look_at = {0, 0, 0};
    return settings;
  }
  static ImageSettings image() { return {width, width}; }

  /// What the pixel (x, y) shows of such light per opacity, if shared.
  template <class Light>
  double shared(float radius, int x, int y, const Light& light) {
    double sum = 0;
    for (const PixelRegression::Share& share : shares(radius, x, y)) {
      const auto pixel = static_cast<int>(share.pixel);
      sum += static_cast<double>(share.weight * opacity[share.pixel]) *
             light(pixel % width, pixel / width);
    }
    return sum / static_cast<double>(opacity[static_cast<std::size_t>(y * width + x)]);
  }
  std::span<const PixelRegression::Share> shares(float radius, int x, int y) {
    depth.clear();
    for (std::size_t i = 0; i < opacity.size(); ++i)
      depth.push_back(opacity[i] * distance[i]);
    return PixelRegression(camera, 1, radius)
        .shares({0, 0, width, width, opacity.data(), depth.data()}, x, y, buffer_);
  }

private:
  PixelRegression::Shares buffer_{};
};

TEST(PixelRegression, KeepsPlanesOfAnyOpacity) {
  Square square;
  Rng rng({1, 1, 0}, RngStage::direct, 0);
  for (float& opacity : square.opacity)
    opacity = 0.02f + 0.98f * rng.uniform();
  for (const float radius : {0.0f, 0.05f, 0.5f, 1.0f, 2.8f})
    for (int y = 0; y < width; ++y)
      for (int x = 0; x < width; ++x) {
        // The same light everywhere is kept to rounding, a slope but for the ridge.
        EXPECT_NEAR(square.shared(radius, x, y, [](int, int) { return 3; }), 3, 1e-4);
        const auto plane = [](int px, int py) { return 20 + 1.5 * px - py; };
        EXPECT_NEAR(square.shared(radius, x, y, plane), plane(x, y), 0.02);
      }
}

TEST(PixelRegression, LessensNoiseTheMoreTheWiderItIs) {
  Square square;
  double before = 1.01;
  for (const float radius : RegressionTrial::radii) {
    double left = 0;
    for (const PixelRegression::Share& share : square.shares(radius, 4, 4))
      left += static_cast<double>(share.weight) * static_cast<double>(share.weight);
    EXPECT_LT(left, before) << radius;
    before = left;
  }
  EXPECT_LT(before, 0.06);
}

/// The squared bias that the fit gives light that bends is as the forecast for narrow radii says.
TEST(PixelRegression, BlursSmoothLightAsItsMeanSquareDistanceSquared) {
  Square square;
  const auto bend = [](int px, int py) { return 100 + (px - 4) * (px - 4) + (py - 4) * (py - 4); };
  const auto bias = [&](float radius) { return square.shared(radius, 4, 4, bend) - 100; };
  const double squared = std::pow(bias(0.05f) / bias(0.25f), 2);
  EXPECT_NEAR(fit_blur(0.05f) / fit_blur(0.25f), squared, 0.15 * squared);
  EXPECT_EQ(fit_blur(0), 0);
  for (std::size_t i = 1; i < RegressionTrial::radii.size(); ++i)
    EXPECT_GT(fit_blur(RegressionTrial::radii[i]), fit_blur(RegressionTrial::radii[i - 1]));
}

TEST(PixelRegression, IsNotAcrossDepths) {
  Square square;
  for (std::size_t i = 0; i < square.distance.size(); ++i)
    square.distance[i] = i % width < 5 ? 5 : 50;
  const auto near_only = [](int px, int) { return px < 5 ? 1 : 1000; };
  EXPECT_NEAR(square.shared(2, 4, 4, near_only), 1, 1e-4);
}

TEST(PixelRegression, LeavesWhatSeesNothing) {
  Square square;
  square.opacity[4 * width + 4] = 0;
  const auto shares = square.shares(2, 4, 4);
  ASSERT_EQ(shares.size(), 1u);
  EXPECT_EQ(shares[0].pixel, std::size_t{4 * width + 4});
  EXPECT_EQ(shares[0].weight, 1);
  for (const PixelRegression::Share& share : square.shares(2, 5, 4))
    EXPECT_NE(share.pixel, std::size_t{4 * width + 4});
}

TEST(PixelRegression, KeepsItsOwnLightAtTheLens) {
  Square square;
  square.distance.assign(square.distance.size(), 0);
  EXPECT_EQ(square.shared(2, 4, 4, [](int px, int) { return px; }), 4);
}

TEST(GatherPlan, SharesLessFromPassToPass) {
  GatherPlan plan{1, 0, {{1, 0.55, 0.4, 0.3, 0.28, 0.25, 0.2, 0.1, 0.07, 0.04}, 0.05}};
  float before = plan.regression_radius(0);
  EXPECT_GT(before, 1);
  for (int pass = 1; pass < 5000; ++pass) {
    const float radius = plan.regression_radius(pass);
    EXPECT_LE(radius, before) << pass;
    before = radius;
  }
  EXPECT_EQ(before, 0);
  EXPECT_LT(plan.walks(0), plan.walks(5000));
  EXPECT_EQ(plan.walks(5000), tuning::walks_of_narrow_fit);
  // What blurs more is shared less, and what has no noise not at all.
  plan.regression.blur = 5;
  EXPECT_LT(plan.regression_radius(0), 1);
  plan.noise = 0;
  EXPECT_EQ(plan.regression_radius(0), 0);
}

/// A cube of stripes, dense and thin.
MemoryScene stripes() {
  MemoryScene scene;
  const Vec3<int> cells{4, 4, 4};
  VolumeSettings& volume =
      scene.add(closed_field(cells, [](int i, int, int) { return i % 2 ? 1.0 : 0.1; }),
                box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 30;
  scene.add_light(LightType::distant).direction = {1, -0.4, -0.5};
  scene.look({0.5, 0.6, 2.5}, {0, 0, 0}, 24, 80, 80);
  return scene;
}

/// Pixels at the edge of a tile share with those of the next.
TEST(GatherPass, FinishedTilesAreThoseOfAWholePass) {
  const MemoryScene scene = stripes();
  const TestFrame frame(scene);
  RenderStatistics statistics;
  PassImage whole;
  FramePasses estimator(EstimatorType::gather, frame.input());
  ASSERT_GT(estimator.choices().gather->regression_radius(0), 0);
  estimator.render_pass(0, whole, statistics);
  for (const int milliseconds : {2, 5, 10, 20, 40}) {
    EstimatorInput input = frame.input();
    StopToken stop;
    input.stop = &stop;
    const auto stopped = make_pass_renderer(EstimatorType::gather, input);
    stop.set_deadline(StopToken::Clock::now() + std::chrono::milliseconds(milliseconds));
    PassImage part;
    stopped->render_pass(0, part, statistics);
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x)
        if (part.finished_tiles[part.tile_of(x, y)]) {
          const std::size_t pixel = static_cast<std::size_t>(y * part.width + x);
          ASSERT_EQ(part.total(pixel), whole.total(pixel)) << x << " " << y;
        }
  }
}

/// A pass that is stopped while its photons are traced leaves nothing of an earlier one.
TEST(GatherPass, APassThatIsStoppedAtItsPhotonsHasNoFinishedTiles) {
  const MemoryScene scene = stripes();
  const TestFrame frame(scene);
  std::atomic<bool> request = false;
  const StopToken stop(&request);
  EstimatorInput input = frame.input();
  input.stop = &stop;
  const auto passes = make_pass_renderer(EstimatorType::gather, input);
  RenderStatistics statistics;
  PassImage image;
  passes->render_pass(0, image, statistics);
  const PixelRegion all{0, 0, image.width, image.height};
  EXPECT_TRUE(is_finished(image, all));
  request = true;
  passes->render_pass(1, image, statistics);
  EXPECT_FALSE(is_finished(image, all));
}

} // namespace
} // namespace vdbeam
