#include "prepare/prepared_scene.h"
#include "support/memory_scene.h"
#include "support/statistics.h"
#include "vdbeam/render.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

constexpr int seeds = 100;

/// One scene of the calibration: small pictures, few photons, so that noise is large.
struct Case {
  std::string name;
  test::MemoryScene memory;
};

void see(test::MemoryScene& scene, const Vec3d& from, const Vec3d& to, double fov) {
  scene.look(from, to, fov, 32, 18);
  scene.scene.render.photons = 1000;
  scene.scene.render.neighbours = 60;
}

/// A lumpy, strongly scattering ball in the sun: most pixels of a photon share its noise.
Case cloud() {
  Case result{"cloud", {}};
  auto lumps = [](int i, int j, int k) {
    const double x = i - 16, y = j - 16, z = k - 16, r = std::sqrt(x * x + y * y + z * z);
    return std::max(0.0, 1 - r / 16) * (1 + std::sin(0.9 * i) * std::sin(1.1 * j + k));
  };
  VolumeSettings& volume = result.memory.add(test::closed_field({4, 4, 4}, lumps),
                                             test::box_map({4, 4, 4}, {-1, -1, -1}, {1, 1, 1}));
  volume.extinction = 20;
  volume.albedo = Rgb(0.98f);
  volume.phase = test::henyey_greenstein(0.6);
  result.memory.add_light(LightType::distant).direction = {-0.5, -0.7, -0.4};
  result.memory.add_light(LightType::environment).radiance = Rgb(0.1f);
  see(result.memory, {0, 0.5, 4}, {0, 0, 0}, 34);
  return result;
}

/// Thin, absorbing smoke: mostly single scattering, each pixel has noise of its own.
Case smoke() {
  Case result{"smoke", {}};
  auto wisps = [](int i, int j, int k) {
    return 0.5 + 0.5 * std::sin(0.7 * i + 0.3 * j) * std::cos(0.5 * k);
  };
  VolumeSettings& volume =
      result.memory.add(test::closed_field({2, 4, 2}, wisps),
                        test::box_map({2, 4, 2}, {-0.5, -1, -0.5}, {0.5, 1, 0.5}));
  volume.extinction = 2;
  volume.albedo = Rgb(0.7f);
  volume.phase = test::henyey_greenstein(0.3);
  result.memory.add_light(LightType::distant).direction = {0.8, -0.5, -0.3};
  see(result.memory, {0, 0, 4}, {0, 0, 0}, 36);
  return result;
}

/// A homogeneous ball lit by a lamp: sharp fall-off of light, dark pixels, colour.
Case ball() {
  Case result{"ball", {}};
  auto inside = [](int i, int j, int k) {
    const double x = i - 16, y = j - 16, z = k - 16;
    return x * x + y * y + z * z < 15.5 * 15.5 ? 1.0 : 0.0;
  };
  VolumeSettings& volume = result.memory.add(test::closed_field({4, 4, 4}, inside),
                                             test::box_map({4, 4, 4}, {-1, -1, -1}, {1, 1, 1}));
  volume.extinction = 6;
  volume.albedo = Rgb(0.95f, 0.9f, 0.8f);
  LightSettings& lamp = result.memory.add_light(LightType::point);
  lamp.position = {0.3, 1.8, 1};
  lamp.intensity = Rgb(5);
  see(result.memory, {0, 0.4, 4}, {0, 0, 0}, 34);
  return result;
}

/// A slab under a sky: all light is the photons'.
Case slab() {
  Case result{"slab", {}};
  VolumeSettings& volume = result.memory.add_box({-2, -0.5, -2}, {2, 0.5, 2});
  volume.extinction = 4;
  volume.albedo = Rgb(0.9f, 0.7f, 0.5f);
  volume.phase = test::henyey_greenstein(0.5);
  result.memory.add_light(LightType::environment).radiance = {0.6f, 0.8f, 1};
  see(result.memory, {1, 2.5, 5}, {0, 0, 0}, 38);
  return result;
}

RenderResult render_seed(Case& scene, int seed, const FrameSettings& frame = {}) {
  Scene& settings = scene.memory.scene;
  settings.volumes[0].file = "in memory";
  settings.render.seed = static_cast<std::uint64_t>(seed);
  const auto prepared = std::make_shared<PreparedScene>();
  prepared->world = std::make_shared<World>(scene.memory.world(&prepared->facts));
  return render(settings, prepared, frame);
}

/// MRSE of each image against the mean of the others: the truth about noise, whatever the bias.
std::vector<double> noise_of(const std::vector<Image>& images) {
  std::vector<double> errors;
  const std::size_t pixels = images[0].channels[0].data.size(), count = images.size();
  for (const Image& image : images) {
    double sum = 0;
    for (const char* channel : {"R", "G", "B"}) {
      std::vector<double> mean(pixels);
      for (const Image& other : images)
        for (std::size_t i = 0; i < pixels; ++i)
          mean[i] += static_cast<double>(other.find(channel)->data[i]) / static_cast<double>(count);
      for (std::size_t i = 0; i < pixels; ++i) {
        const double d = static_cast<double>(image.find(channel)->data[i]) - mean[i];
        sum += d * d / ((mean[i] + 0.01) * (mean[i] + 0.01));
      }
    }
    // The mean holds the image itself.
    errors.push_back(sum / (3 * static_cast<double>(pixels)) * static_cast<double>(count) /
                     static_cast<double>(count - 1));
  }
  return errors;
}

class ErrorCalibrationSlow : public ::testing::TestWithParam<Case (*)()> {};

/// The share of seeds for which a 95 % interval must hold the truth; it is made to be rather too
/// wide than too narrow. Of 100 seeds, fewer than 90 would be inside with a chance of 1 % where
/// 95 % are expected to be.
void expect_calibrated(int inside) {
  EXPECT_GE(inside, 90);
  EXPECT_LE(inside, 99);
}

/// Noise and bias together against an image by path tracing; with more rays followed than by
/// default, since so few pixels would show no bias otherwise.
TEST_P(ErrorCalibrationSlow, TrueErrorLiesInItsIntervalAndTargetsAreMet) {
  Case scene = GetParam()();
  RenderSettings& settings = scene.memory.scene.render;
  settings.estimator = EstimatorType::path;
  settings.passes = 300;
  RenderResult truth = render_seed(scene, 12345);
  const double truth_noise = truth.passes.back().noise_estimate;
  settings.estimator = EstimatorType::automatic;
  settings.passes = 11;
  settings.bias_rays = 0.2;
  FrameSettings frame;
  frame.reference = &truth.image;

  std::vector<Image> images;
  int inside = 0;
  double error = 0, estimate = 0, noise = 0;
  test::Samples bias_errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    RenderResult result = render_seed(scene, seed, frame);
    const PassRecord& last = result.passes.back();
    const double actual = last.mrse - truth_noise;
    inside += last.error_low <= actual && actual <= last.error_high ? 1 : 0;
    error += actual / seeds;
    estimate += last.error_estimate / seeds;
    noise += last.noise_estimate / seeds;
    bias_errors.add(last.bias_estimate - last.bias);
    images.push_back(std::move(result.image));
  }
  double actual_noise = 0;
  for (const double one : noise_of(images))
    actual_noise += one / seeds;
  expect_calibrated(inside);
  EXPECT_NEAR(estimate / error, 1, 0.15);
  EXPECT_NEAR(noise / actual_noise, 1, 0.15);
  // The reference is itself noisy, by some 0.1 % of the brightness.
  test::expect_mean(bias_errors, 0, 0.003);

  settings.passes.reset();
  settings.target_error = 0.8 * error;
  double stopped = 0;
  constexpr int runs = 25;
  for (int seed = 1; seed <= runs; ++seed) {
    const RenderResult result = render_seed(scene, 1000 + seed, frame);
    EXPECT_EQ(result.stopped_by, "target_error");
    stopped += (result.passes.back().mrse - truth_noise) / runs;
  }
  EXPECT_NEAR(stopped / *settings.target_error, 1, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ErrorCalibrationSlow, ::testing::Values(cloud, smoke, ball, slab),
                         [](const auto& scene) { return scene.param().name; });

/// Path tracing has no bias and unlike noise: rare bright paths, and no two pixels share any.
TEST(PathErrorSlow, LiesInItsIntervalAsOftenAsStated) {
  Case scene = ball();
  RenderSettings& settings = scene.memory.scene.render;
  settings.estimator = EstimatorType::path;
  settings.passes = 12;
  std::vector<Image> images;
  std::vector<PassRecord> records;
  for (int seed = 1; seed <= seeds; ++seed) {
    RenderResult result = render_seed(scene, seed);
    images.push_back(std::move(result.image));
    records.push_back(result.passes.back());
  }
  const std::vector<double> truth = noise_of(images);
  int inside = 0;
  double estimate = 0, actual = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    inside += records[i].error_low <= truth[i] && truth[i] <= records[i].error_high ? 1 : 0;
    estimate += records[i].error_estimate;
    actual += truth[i];
    EXPECT_EQ(records[i].bias_estimate, 0);
  }
  expect_calibrated(inside);
  EXPECT_NEAR(estimate / actual, 1, 0.15);
}

TEST(BiasProbe, RunsWhereThereMayBeBiasAndChangesNoPicture) {
  Case scene = slab();
  RenderSettings& settings = scene.memory.scene.render;
  settings.passes = 3;
  settings.bias_rays = 0;
  const RenderResult without = render_seed(scene, 1);
  EXPECT_EQ(without.statistics.bias_rays, 0u);
  EXPECT_TRUE(std::isnan(without.passes.back().bias_estimate));
  settings.bias_rays = 0.25;
  const RenderResult with = render_seed(scene, 1);
  EXPECT_EQ(with.statistics.bias_rays / 3, 32u * 18u / 4u) << "a quarter of the pixels in turn";
  EXPECT_EQ(with.image.find("R")->data, without.image.find("R")->data);
  settings.estimator = EstimatorType::path;
  EXPECT_EQ(render_seed(scene, 1).statistics.bias_rays, 0u);
}

} // namespace
} // namespace vdbeam
