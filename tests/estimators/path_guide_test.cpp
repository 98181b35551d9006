// Light paths that go where the picture is made: nothing is lost by it, and the picture gains.
#include "choose/choose.h"

#include "support/render_passes.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <deque>

namespace vdbeam {
namespace {

using namespace test;

/// A lumpy cube, 40 mean free paths deep, lit from behind and a little by the sky.
MemoryScene lit_from_behind(double depth = 40) {
  MemoryScene scene;
  const DensityField field = closed_field(
      {8, 8, 8}, [](int i, int j, int k) { return 0.5 + lattice_noise(i / 4, j / 4, k / 4); });
  VolumeSettings& volume = scene.add(field, box_map({8, 8, 8}, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = depth;
  volume.albedo = {0.999f, 0.99f, 0.98f};
  volume.phase = henyey_greenstein(0.4);
  scene.add_light(LightType::distant).direction = {0.3, -0.2, 1};
  scene.add_light(LightType::environment).radiance = {0.03f, 0.05f, 0.1f};
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 24, 24);
  scene.scene.render.photons = 20000;
  return scene;
}

/// A second medium that overlaps the first, of larger cells.
void add_haze(MemoryScene& scene) {
  VolumeSettings& haze = scene.add_box({-0.4, -0.6, 0}, {0.8, 0.4, 0.9});
  haze.extinction = 2;
  haze.albedo = {0.5f, 0.7f, 0.9f};
}

struct Planned {
  explicit Planned(const MemoryScene& scene)
      : frame(scene), world(frame.world),
        plan(choose_for_scene(frame.input(), estimator_kind(EstimatorType::beam)).choices.photons) {
  }

  /// Powers of the photons of one pass in the skin that is seen, two mean free paths thick, and in
  /// all of the medium.
  std::array<double, 2> powers(bool guided, std::uint64_t pass) const {
    PhotonPassSettings settings = pass_settings(frame.input(), plan, pass);
    if (!guided)
      settings.guide = nullptr;
    const PhotonList photons = trace_photons(world, settings).photons;
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < photons.size(); ++i) {
      const double power = mean_component(Vec3d(photons.power[i]));
      const double z =
          static_cast<double>(photons.position[i].z) / world.space.scale + world.space.origin.z;
      sums[0] += z > 0.45 && z < 0.5 ? power : 0;
      sums[1] += power;
    }
    return sums;
  }

  TestFrame frame;
  const World& world;
  PhotonPlan plan;
};

TEST(PathGuide, LosesNothing) {
  for (const bool haze : {false, true}) {
    MemoryScene scene = lit_from_behind();
    if (haze)
      add_haze(scene);
    const Planned planned(scene);
    ASSERT_TRUE(planned.plan.guide);
    std::array<Samples, 2> guided, plain;
    // A ratio of variances from n passes has a relative standard error of 2 / sqrt(n).
    for (std::uint64_t pass = 0; pass < (haze ? 60u : 400u); ++pass) {
      const std::array<double, 2> a = planned.powers(true, pass),
                                  b = planned.powers(false, 1000 + pass);
      for (std::size_t i : {0u, 1u}) {
        guided[i].add(a[i]);
        plain[i].add(b[i]);
      }
    }
    for (std::size_t i : {0u, 1u}) {
      expect_same_mean(guided[i], plain[i]);
      EXPECT_LT(guided[i].error(), 0.05 * guided[i].mean()) << i;
      EXPECT_LT(plain[i].error(), 0.05 * plain[i].mean()) << i;
    }
    // The picture is made in the skin: less noise there, for more on the far side.
    if (!haze) {
      EXPECT_LT(guided[0].variance(), 0.7 * plain[0].variance());
    }
  }
}

/// At equal kernels the picture is the same, with less noise per path; the colours of the albedo
/// and of the sky make throughputs that are not grey.
TEST(PathGuide, PicturesAreTheSameWithLessNoise) {
  MemoryScene scene = lit_from_behind();
  scene.scene.render.kernel = KernelRadius::fixed;
  scene.scene.render.radius = 0.08;
  scene.scene.render.alpha = 1;
  PassMeans means[2];
  for (const PhotonThinning thinning : {PhotonThinning::even, PhotonThinning::view}) {
    scene.scene.render.thinning = thinning;
    means[thinning == PhotonThinning::view] = render_passes(scene, EstimatorType::beam, 40);
  }
  for (std::size_t c = 0; c < 3; ++c)
    expect_same_mean(means[0].indirect[c], means[1].indirect[c]);
  EXPECT_LT(means[1].indirect[0].error(), 0.02 * means[1].indirect[0].mean());
  const auto noise = [](const PassMeans& m) {
    return m.indirect[0].variance() * static_cast<double>(m.statistics.light_paths);
  };
  EXPECT_LT(noise(means[1]), 0.7 * noise(means[0]));
}

TEST(PathGuide, EmissionIsADensity) {
  const Planned planned(lit_from_behind());
  const PathGuide& guide = *planned.plan.guide;
  double shares = 0;
  for (std::size_t l = 0; l < 2; ++l) {
    shares += guide.light_shares[l];
    EXPECT_GT(guide.light_shares[l], 0.001);
    // The mean of 1 / density over draws is the measure of all places, 1; places rise with u.
    double sum = 0, before = -1;
    constexpr int draws = 200000;
    for (int i = 0; i < draws; ++i) {
      const PathGuide::Emission emission = guide.emission(l, (i + 0.5) / draws);
      ASSERT_GT(emission.place, before);
      ASSERT_LT(emission.place, 1);
      before = emission.place;
      sum += 1 / emission.density / draws;
    }
    EXPECT_NEAR(sum, 1, 1e-3);
    for (const double u : {0.0, 1 - 0x1p-30})
      EXPECT_TRUE(guide.emission(l, u).place >= 0 && guide.emission(l, u).place < 1);
  }
  EXPECT_NEAR(shares, 1, 1e-12);
}

TEST(PathGuide, IsTheSameForAnyThreads) {
  const MemoryScene scene = lit_from_behind();
  std::deque<Planned> planned;
  std::vector<PhotonList> photons;
  for (const int threads : {1, 3})
    tbb::task_arena(threads).execute([&] {
      const Planned& p = planned.emplace_back(scene);
      photons.push_back(trace_photons(p.world, pass_settings(p.frame.input(), p.plan, 5)).photons);
    });
  EXPECT_EQ(*planned[0].plan.guide, *planned[1].plan.guide);
  EXPECT_EQ(photons[0].position, photons[1].position);
  EXPECT_EQ(photons[0].power, photons[1].power);
}

/// Where paths are split until their flux is small, the roulette on their length still ends them.
TEST(PathGuide, WorkIsBoundedInADeepMedium) {
  MemoryScene scene = lit_from_behind(1e5);
  scene.scene.volumes[0].albedo = Rgb(1);
  const Planned planned(scene);
  PhotonPassSettings settings = pass_settings(planned.frame.input(), planned.plan, 0);
  settings.paths = 2000;
  EXPECT_LT(trace_photons(planned.world, settings).mean_collisions, 50000);
}

TEST(MediumBlocks, CoverTheMedium) {
  MemoryScene scene;
  scene.add(closed_field({150, 2, 1}, [](int, int, int) { return 1; }),
            box_map({150, 2, 1}, Vec3d(0), {150, 2, 1}));
  scene.add_light(LightType::environment);
  const World world = scene.world();
  const MediumBlocks blocks(world.medium);
  ASSERT_EQ(blocks.counts(0), (Vec3<int>{64, 1, 1})); // a block is 150 / 64 cells wide
  for (int x = 0; x < 64; ++x)
    EXPECT_EQ(blocks.at(blocks.point(0, {x, 0, 0}, Vec3f(0.5f))), static_cast<std::size_t>(x));
  EXPECT_EQ(blocks.at(Vec3f(-1e3f)), 0u);
  EXPECT_EQ(blocks.at(Vec3f(1e3f)), 63u);
  // No finer than the cells.
  const World coarse = lit_from_behind().world();
  EXPECT_EQ(MediumBlocks(coarse.medium).counts(0), (Vec3<int>{8, 8, 8}));
}

/// A small box in a wide one has a lattice of its own; a point belongs to one block of one lattice.
TEST(MediumBlocks, ResolveNests) {
  MemoryScene scene;
  scene.add(uniform_field({16, 16, 16}, 1), box_map({16, 16, 16}, Vec3d(-20), Vec3d(20)));
  scene.add(uniform_field({8, 8, 8}, 1), box_map({8, 8, 8}, Vec3d(-1), Vec3d(1)));
  scene.add_light(LightType::environment);
  const World world = scene.world();
  ASSERT_EQ(world.medium.nests.size(), 1u);
  const MediumBlocks blocks(world.medium);
  ASSERT_EQ(blocks.lattices(), 2u);
  EXPECT_EQ(blocks.counts(0), (Vec3<int>{8, 8, 8}));
  EXPECT_EQ(blocks.size(), blocks.first(1) + 64 * 64 * 64);
  const auto at = [&](const Vec3d& p) { return blocks.at(Vec3f(world.space.point(p))); };
  EXPECT_EQ(at(Vec3d(-0.99)), 0u);
  EXPECT_EQ(at(Vec3d(0.99)), blocks.first(1) - 1);
  EXPECT_GE(at(Vec3d(1.01)), blocks.first(1));
  EXPECT_EQ(at(Vec3d(100)), blocks.size() - 1);
  EXPECT_EQ(blocks.at(blocks.point(1, {3, 5, 7}, Vec3f(0.5f))),
            blocks.first(1) + (3 * 64 + 5) * 64 + 7);
}

} // namespace
} // namespace vdbeam
