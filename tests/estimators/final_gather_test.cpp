// When photons are gathered by walks, and that it lessens the blur of kernels.
#include "support/lumpy_cloud.h"
#include "support/render_passes.h"

#include "choose/pass_renderer.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

bool gathers_finally(const MemoryScene& scene,
                     const EstimatorType& estimator = EstimatorType::automatic) {
  const TestFrame frame(scene);
  return FramePasses(estimator, frame.input()).choices().gather.has_value();
}

/// The few walks that come near a lamp among the lumps are far brighter than the others, so kernels
/// have less noise.
TEST(FinalGather, IsUsedWhereItPays) {
  MemoryScene scene = lumpy_cloud(160, 48);
  EXPECT_TRUE(gathers_finally(scene));
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {0, 0, 0};
  lamp.intensity = Rgb(100);
  EXPECT_FALSE(gathers_finally(scene));
}

/// A lamp among the lumps that hardly shines takes nothing from the light of the sun.
TEST(FinalGather, IsUsedBesideAFaintLamp) {
  MemoryScene scene = lumpy_cloud(160, 160);
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {0, 0, 0};
  lamp.intensity = Rgb(1e-4f);
  EXPECT_TRUE(gathers_finally(scene));
}

TEST(FinalGather, FollowsTheEstimatorAndTheSettings) {
  MemoryScene scene = lumpy_cloud(160, 160);
  RenderSettings& render = scene.scene.render;
  const auto gathers = [&] { return gathers_finally(scene, EstimatorType::gather); };
  EXPECT_FALSE(gathers_finally(scene, EstimatorType::beam));
  EXPECT_TRUE(gathers());
  render.max_bounces = 8;
  EXPECT_FALSE(gathers());
  render.max_bounces.reset();
  render.direct = DirectLight::photons; // no walk would meet a sun without extent
  EXPECT_FALSE(gathers());
}

/// Kernels as wide as the lumps: the mean over many passes is off by their blur, and less so where
/// photons are gathered by walks.
TEST(FinalGather, LessensTheBlur) {
  MemoryScene scene = lumpy_cloud(40, 48);
  RenderSettings& render = scene.scene.render;
  const PassMeans truth = render_passes(scene, EstimatorType::path, 200);
  render.kernel = KernelRadius::fixed;
  render.radius = 0.1;
  render.photons = 40000;
  const auto squared_error = [&](const EstimatorType& estimator) {
    const PassMeans means = render_passes(scene, estimator, 64);
    double sum = 0;
    for (std::size_t i = 0; i < means.brightness.size(); ++i) {
      const Samples &a = means.brightness[i], &b = truth.brightness[i];
      const double d = a.mean() - b.mean();
      sum += d * d - a.error() * a.error() - b.error() * b.error();
    }
    return sum / static_cast<double>(means.brightness.size());
  };
  const double along = squared_error(EstimatorType::beam);
  const double walks = squared_error(EstimatorType::gather);
  EXPECT_GT(along, 0);
  EXPECT_LT(walks, along / 4);
}

/// At a probed pixel the blur is measured by the same walks in narrower kernels, and no pixel
/// changes for it.
TEST(FinalGather, EstimatesItsBlur) {
  MemoryScene scene = lumpy_cloud(40, 48);
  RenderSettings& render = scene.scene.render;
  render.kernel = KernelRadius::fixed;
  render.radius = 0.15;
  render.photons = 20000;
  const TestFrame frame(scene);
  std::vector<std::size_t> pixels(48 * 48);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = i;
  const auto mean_blur = [&](bool probed, PassImage& image) {
    EstimatorInput input = frame.input();
    input.blur_pixels = probed ? &pixels : nullptr;
    RenderStatistics statistics;
    make_pass_renderer(EstimatorType::gather, input)->render_pass(0, image, statistics);
    double sum = 0;
    for (const PixelValue& blur : image.blur)
      sum += std::abs(static_cast<double>(blur.radiance.x));
    return sum;
  };
  PassImage probed, plain;
  EXPECT_GT(mean_blur(true, probed), 0);
  EXPECT_EQ(mean_blur(false, plain), 0);
  EXPECT_EQ(probed.blur.size(), pixels.size());
  EXPECT_EQ(probed.indirect, plain.indirect);
}

} // namespace
} // namespace vdbeam
