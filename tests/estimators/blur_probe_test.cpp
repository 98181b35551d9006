// The kernels' blur that a pass measures is the difference to a pass with narrower kernels.
#include "support/render_passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace vdbeam {
namespace {

using namespace test;

/// A coloured box in a sky that photons bring, and in a sun. The kernels are far wider than its
/// edges are sharp.
MemoryScene box(double radius) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  volume.extinction = 5;
  volume.albedo = {0.9f, 0.8f, 0.7f};
  volume.phase = henyey_greenstein(0.4);
  scene.add_light(LightType::environment).radiance = {0.5f, 0.7f, 1};
  scene.add_light(LightType::distant).direction = {0.3, -1, -0.2};
  scene.look({4, 3, 40}, {0, 0, 0}, 2.4, 40, 24);
  scene.scene.render.kernel = KernelRadius::fixed;
  scene.scene.render.radius = radius;
  scene.scene.render.photons = 20000;
  scene.scene.render.thinning = PhotonThinning::even;
  scene.scene.render.forward_peak = ForwardPeak::kept;
  return scene;
}

PassImage first_pass(const MemoryScene& scene, const std::vector<std::size_t>* blur_pixels) {
  const TestFrame frame(scene);
  EstimatorInput input = frame.input();
  input.blur_pixels = blur_pixels;
  RenderStatistics statistics;
  PassImage image;
  make_pass_renderer(EstimatorType::beam, input)->render_pass(0, image, statistics);
  return image;
}

/// The whole bias is 1 / (1 - 0.5^1.5) times that difference.
TEST(BlurProbe, FollowsFromTheDifferenceToNarrowerKernels) {
  const float all_of_it = 1 / (1 - std::pow(0.5f, 1.5f));
  std::vector<std::size_t> pixels(40 * 24 / 3);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = 3 * i + 1;
  const PassImage wide = first_pass(box(0.2), &pixels), narrow = first_pass(box(0.1), nullptr);
  ASSERT_EQ(wide.blur.size(), pixels.size());
  double largest = 0;
  for (const PixelValue& blur : wide.blur)
    for (int c = 0; c < 3; ++c) {
      const float expected = wide.total(blur.pixel)[c] - narrow.total(blur.pixel)[c];
      // Rays of a tile share the distances of photons, which a single ray does not.
      EXPECT_NEAR(blur.radiance[c] / all_of_it, expected, 0.002f * wide.total(blur.pixel)[c]);
      largest = std::max(largest, static_cast<double>(std::abs(expected)));
    }
  EXPECT_GT(largest, 0.05);
  EXPECT_TRUE(narrow.blur.empty());
  EXPECT_EQ(wide.indirect, first_pass(box(0.2), nullptr).indirect);
}

} // namespace
} // namespace vdbeam
