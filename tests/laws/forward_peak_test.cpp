// Media whose forward peak is taken out of multiple scattering obey the laws and agree with path.
#include "choose/schedule.h"
#include "medium/optical_depth.h"
#include "phase/truncated_phase.h"
#include "photons/photon_plan.h"
#include "transport/similar_medium.h"

#include "support/memory_scene.h"
#include "support/render_passes.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

constexpr int side = 12;

/// Lumps with soft edges in a box, so that rays meet rims of every opacity.
MemoryScene lumps(double depth, const PhaseSettings& phase) {
  MemoryScene scene;
  const DensityField field = closed_field({3, 3, 3}, [](int i, int j, int k) {
    double density = 0;
    for (int n = 0; n < 5; ++n) {
      const double x = 6 + 3 * (n % 3) + 2 * (n / 3), y = 7 + 5 * (n % 2), z = 8 + 2 * n;
      const double d = std::sqrt((i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z));
      density = std::max(density, std::clamp((6 - d) / 2, 0.0, 1.0));
    }
    return density;
  });
  VolumeSettings& volume = scene.add(field, box_map({3, 3, 3}, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = depth;
  volume.phase = phase;
  scene.look({0.5, 0.8, 3}, {0, 0, 0}, 24, side, side);
  return scene;
}

PhaseSettings mie() {
  PhaseSettings phase;
  phase.type = PhaseType::mie;
  return phase;
}

/// Means and squared standard errors of each pixel.
struct Picture {
  std::vector<double> mean, variance;
};

Picture render(const MemoryScene& scene, int passes) {
  const test::TestFrame frame(scene);
  const auto estimator = frame.estimator();
  PassImage image;
  RenderStatistics statistics;
  std::vector<double> sums(side * side), squares(side * side);
  for (int pass = 0; pass < passes; ++pass) {
    estimator->render_pass(pass, image, statistics);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double value = static_cast<double>(mean_component(image.total(i)));
      sums[i] += value;
      squares[i] += value * value;
    }
  }
  Picture picture;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    picture.mean.push_back(sums[i] / passes);
    const double spread = squares[i] / passes - picture.mean[i] * picture.mean[i];
    picture.variance.push_back(std::max(0.0, spread) / (passes - 1));
  }
  return picture;
}

/// The same where photons are gathered by walks from the camera rays.
TEST(ForwardPeakBeam, FurnaceOfLumpsByFinalGathering) {
  for (const PhaseSettings& phase : {henyey_greenstein(0.9), mie()}) {
    MemoryScene scene = lumps(10, phase);
    scene.add_light(LightType::environment).radiance = Rgb(1);
    scene.scene.render.estimator = EstimatorType::gather;
    scene.scene.render.photons = 40000;
    scene.scene.render.neighbours = 300;
    const Picture picture = render(scene, 48);
    double mean = 0, worst = 0;
    for (std::size_t i = 0; i < picture.mean.size(); ++i) {
      EXPECT_NEAR(picture.mean[i], 1, 5 * std::sqrt(picture.variance[i]) + 0.03) << i;
      mean += picture.mean[i] / static_cast<double>(picture.mean.size());
      worst = std::max(worst, picture.variance[i]);
    }
    EXPECT_LT(std::sqrt(worst), 0.06);
    EXPECT_NEAR(mean, 1, 0.005);
  }
}

class ForwardPeak : public testing::TestWithParam<EstimatorType> {};

/// With albedo 1 and a sky of 1 every pixel is 1, also rims where the peak alone carries light, and
/// whether the sky is left to photons (a constant one) or sampled.
TEST_P(ForwardPeak, FurnaceOfLumps) {
  for (const bool sampled : {false, true})
    for (const PhaseSettings& phase : {henyey_greenstein(0.9), mie()}) {
      MemoryScene scene = lumps(10, phase);
      scene.add_light(LightType::environment).radiance = Rgb(1);
      scene.scene.render.estimator = GetParam();
      scene.scene.render.photons = 40000;
      scene.scene.render.neighbours = 300;
      if (sampled)
        scene.scene.render.direct = DirectLight::sampled;
      const Picture picture = render(scene, 96);
      double worst = 0;
      for (std::size_t i = 0; i < picture.mean.size(); ++i) {
        // 5 standard errors, and the bias of kernels at rims.
        EXPECT_NEAR(picture.mean[i], 1, 5 * std::sqrt(picture.variance[i]) + 0.06) << i << sampled;
        worst = std::max(worst, picture.variance[i]);
      }
      EXPECT_LT(std::sqrt(worst), 0.06); // the test can see an error of 36 % in a pixel
      double mean = 0;
      for (const double value : picture.mean)
        mean += value / static_cast<double>(picture.mean.size());
      EXPECT_NEAR(mean, 1, 0.01) << sampled;
    }
}

INSTANTIATE_TEST_SUITE_P(Estimators, ForwardPeak,
                         testing::Values(EstimatorType::beam, EstimatorType::march),
                         [](const auto& kind) {
                           return kind.param == EstimatorType::beam ? "Beam" : "March";
                         });

/// Lit from behind, pixel by pixel against path.
TEST(ForwardPeakBeam, AgreesWithPathLitFromBehind) {
  for (const PhaseSettings& phase : {henyey_greenstein(0.85), mie()}) {
    MemoryScene scene = lumps(15, phase);
    LightSettings& sun = scene.add_light(LightType::distant);
    sun.direction = {0.35, -0.3, 0.88};
    sun.angular_radius = 2;
    scene.add_light(LightType::environment).radiance = Rgb(0.05f);
    scene.scene.render.photons = 40000;
    scene.scene.render.neighbours = 60;
    scene.scene.render.estimator = EstimatorType::beam;
    const Picture beam = render(scene, 32);
    scene.scene.render.estimator = EstimatorType::path;
    const Picture path = render(scene, 700);
    double sum_beam = 0, sum_path = 0, variance = 0;
    for (std::size_t i = 0; i < beam.mean.size(); ++i) {
      const double error = std::sqrt(beam.variance[i] + path.variance[i]);
      EXPECT_NEAR(beam.mean[i], path.mean[i], 5 * error + 0.12 * path.mean[i]) << i;
      sum_beam += beam.mean[i];
      sum_path += path.mean[i];
      variance += error * error;
    }
    EXPECT_NEAR(sum_beam / sum_path, 1, 4 * std::sqrt(variance) / sum_path + 0.015);
    EXPECT_LT(4 * std::sqrt(variance) / sum_path, 0.05);
  }
}

/// Towards the sun, the light that the peak alone scatters is much of what is seen: counted once
/// for each of its scatterings it would be up to three times too bright.
TEST(ForwardPeakBeam, AgreesWithPathTowardsTheSun) {
  const std::pair<double, double> skies[] = {{0.7, 10}, {0.85, 5}, {0.85, 15}}; // g, degrees
  for (const auto& [g, degrees] : skies) {
    MemoryScene scene = lumps(6, henyey_greenstein(g));
    const Vec3d view = normalize(scene.scene.camera.look_at - scene.scene.camera.position);
    LightSettings& sun = scene.add_light(LightType::distant);
    sun.direction = turn({1, 0, 0}, degrees).vector(-view);
    sun.angular_radius = 1;
    sun.visible = false;
    scene.scene.render.photons = 20000;
    scene.scene.render.neighbours = 60;
    const Picture beam = render(scene, 16);
    scene.scene.render.estimator = EstimatorType::path;
    const Picture path = render(scene, 160);
    double sum_beam = 0, sum_path = 0, variance = 0;
    for (std::size_t i = 0; i < beam.mean.size(); ++i) {
      sum_beam += beam.mean[i];
      sum_path += path.mean[i];
      variance += beam.variance[i] + path.variance[i];
    }
    const double error = 4 * std::sqrt(variance) / sum_path;
    EXPECT_NEAR(sum_beam / sum_path, 1, error + 0.03) << g << " at " << degrees << " degrees";
    EXPECT_LT(error, 0.07); // without the aureole they are 11 to 79 % apart
  }
}

float mean_cosine(const PhaseFunction& phase) {
  return static_cast<float>(legendre_moments(phase, 2)[1]);
}

/// Lines through a ball of radius R are 4/3 R long on average, and 2 R squared.
TEST(TypicalDepth, IsThatOfChordsWeightedByTheirLength) {
  const double sigma = 3, radius = 0.4;
  MemoryScene scene;
  const DensityField ball = closed_field({8, 8, 8}, [](int i, int j, int k) {
    const double d =
        std::sqrt((i - 31.5) * (i - 31.5) + (j - 31.5) * (j - 31.5) + (k - 31.5) * (k - 31.5));
    return d < 0.4 * 64 ? 1.0 : 0.0;
  });
  scene.add(ball, box_map({8, 8, 8}, Vec3d(-0.5), Vec3d(0.5))).extinction = sigma;
  EXPECT_NEAR(typical_depth(scene.world().medium), 1.5 * radius * sigma, 0.1 * radius * sigma);
  scene.scene.volumes[0].extinction = 1e6;
  EXPECT_NEAR(typical_depth(scene.world().medium), opaque_optical_depth, 0.1);
}

/// The worlds of passes, as the schedule has them.
struct OrderedWorlds {
  explicit OrderedWorlds(const World& world)
      : first(choose_peak_orders(world.medium)), worlds(world) {}

  int order(int pass, bool gathers = false) const { return peak_order(first, pass, gathers); }
  const World& of(int pass, bool gathers = false) { return worlds.of(order(pass, gathers)); }

  PeakOrders first;
  PassWorlds worlds;
};

/// Where light is scattered but a few times, the truncation of each scattering shows. The mean
/// order grows steadily as the medium gets thinner, so that no frame of a sequence jumps.
TEST(PassWorlds, TakeOutLessOfThinMedia) {
  double before = 4;
  for (const double depth : {100.0, 60.0, 40.0, 25.0, 15.0, 10.0, 6.0, 4.0, 2.5, 1.5}) {
    const MemoryScene scene = lumps(depth, henyey_greenstein(0.85));
    const World world = scene.world();
    OrderedWorlds worlds(world);
    double mean = 0;
    for (int pass = 0; pass < 64; ++pass)
      mean += worlds.order(pass) / 64.0;
    EXPECT_GE(mean, before);
    EXPECT_LT(mean, before + 1.5);
    before = mean;
  }
  EXPECT_GT(before, 7.5);
}

TEST(PassWorlds, TakeOutLessAndLess) {
  const MemoryScene scene = lumps(1000, henyey_greenstein(0.9));
  const World world = scene.world();
  OrderedWorlds worlds(world);
  float before = 1;
  for (const int pass : {0, 65, 192, 576, 100000}) { // none of them takes less out
    const World& similar = worlds.of(pass);
    ASSERT_TRUE(similar.medium.peak);
    EXPECT_LT(similar.medium.peak->forward[0], before);
    before = similar.medium.peak->forward[0];
    // Absorption and the transport cross-section stay.
    const Volume &a = world.medium.volumes[0], &b = similar.medium.volumes[0];
    EXPECT_NEAR(a.extinction * (1 - a.albedo.x), b.extinction * (1 - b.albedo.x),
                1e-4f * a.extinction);
    EXPECT_NEAR(a.extinction * a.albedo.x * (1 - mean_cosine(world.medium.phases[0])),
                b.extinction * b.albedo.x * (1 - mean_cosine(similar.medium.phases[0])),
                1e-4f * a.extinction);
  }
  EXPECT_FALSE(PassWorlds(world).of(0).medium.peak);
}

/// One pass of each pair takes less out, and its bias is smaller by a ratio that is known.
TEST(PassWorlds, TellTruncationByTakingOutMoreAndLess) {
  const float g = 0.85f;
  const MemoryScene scene = lumps(1000, henyey_greenstein(g));
  const World world = scene.world();
  OrderedWorlds worlds(world);
  for (const bool walks : {false, true})
    for (const int pass : {0, 2, 40, 100, 500}) {
      EXPECT_EQ(std::abs(worlds.order(pass + 1, walks) - worlds.order(pass, walks)), 2);
      const float a = truncation(worlds.of(pass, walks).medium);
      const float b = truncation(worlds.of(pass + 1, walks).medium);
      EXPECT_NEAR(std::min(a, b) / std::max(a, b), std::pow(g, 4), 1e-4);
    }
  int first_higher = 0; // of four pairs; half of them begin with it
  for (int pair = 8; pair < 12; ++pair)
    first_higher += worlds.order(2 * pair) > worlds.order(2 * pair + 1) ? 1 : 0;
  EXPECT_EQ(first_higher, 2);
  EXPECT_EQ(truncation(world.medium), 0);
  const MemoryScene droplets = lumps(1000, henyey_greenstein(0.97));
  const World peaked = droplets.world();
  OrderedWorlds of_peaked(peaked);
  for (const int pass : {0, 1000})
    EXPECT_EQ(std::abs(of_peaked.order(pass + 1) - of_peaked.order(pass)), 2)
        << "at the highest orders too";
}

/// Walks blur so little that truncation would be most of the bias: no more than 55 % is taken out.
TEST(PassWorlds, TakeOutLessWhereWalksGather) {
  for (const double g : {0.7, 0.85, 0.9}) {
    const MemoryScene scene = lumps(1000, henyey_greenstein(g));
    const World world = scene.world();
    OrderedWorlds worlds(world);
    for (const int pass : {16, 100, 1000}) {
      EXPECT_GE(worlds.order(pass, true), worlds.order(pass));
      const World& similar = worlds.of(pass, true);
      EXPECT_LE(similar.medium.peak ? similar.medium.peak->forward[0] : 0, 0.55f);
    }
  }
  const MemoryScene scene = lumps(1000, henyey_greenstein(0.88));
  const World world = scene.world();
  OrderedWorlds worlds(world);
  EXPECT_GT(worlds.order(8, true), worlds.order(8));
}

/// The squared bias halves with each order, the noise with each doubling of the passes.
TEST(PassWorlds, TakeOutLessWithEachDoublingWhereWalksGather) {
  const MemoryScene scene = lumps(1000, henyey_greenstein(0.85));
  const World world = scene.world();
  OrderedWorlds worlds(world);
  const auto mean_order = [&](int first, int passes) {
    double sum = 0;
    for (int pass = first; pass < first + passes; ++pass)
      sum += worlds.order(pass, true);
    return sum / passes;
  };
  const double at_first = mean_order(0, 16);
  for (int doublings = 0; doublings < 3; ++doublings)
    EXPECT_NEAR(mean_order(16 << doublings, 16 << doublings), at_first + 1 + doublings, 0.35);
}

} // namespace
} // namespace vdbeam
