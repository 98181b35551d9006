// Scenes of many volumes: rays find those that they meet, and no light changes by that.
#include "medium/volume_tree.h"

#include "math/sampling.h"
#include "medium/delta_tracking.h"
#include "medium/depth_profile.h"
#include "support/render_passes.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using test::MemoryScene;
using test::Samples;

Vec3d place_in(double half, Rng& rng) {
  const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
  return {(2 * x - 1) * half, (2 * y - 1) * half, (2 * z - 1) * half};
}

Segment line(Rng& rng) {
  const Vec3f from(place_in(2, rng)), to(place_in(0.8, rng));
  return {{from, normalize(to - from)}, 0, infinity};
}

/// Copies of a small cloud in a cube from -1 to 1; some overlap.
MemoryScene copies(int count) {
  MemoryScene scene;
  const DensityField cloud = test::closed_field(
      {2, 2, 2}, [](int i, int j, int k) { return 0.3 + test::lattice_noise(i, j, k); });
  Rng rng({}, RngStage::test, 5);
  for (int i = 0; i < count; ++i) {
    const Vec3d center = place_in(1, rng);
    scene.add(cloud, test::box_map({2, 2, 2}, center - Vec3d(0.05), center + Vec3d(0.05)))
        .extinction = 8;
  }
  return scene;
}

TEST(VolumeTree, FindsWhatASearchOfAllBoxesFinds) {
  Rng rng({}, RngStage::test, 1);
  std::vector<Boxf> boxes;
  for (int i = 0; i < 500; ++i) {
    const Vec3f lower(place_in(1, rng));
    boxes.push_back({lower, lower + Vec3f(0.1f * rng.uniform())});
  }
  const VolumeTree tree(boxes);
  std::size_t hits = 0;
  for (int ray = 0; ray < 2000; ++ray) {
    Segment segment = line(rng);
    if (ray % 3 == 0)
      segment.t_end = 2 * rng.uniform();
    if (ray % 7 == 0)
      segment.ray.direction = {0, 0, 1};
    std::vector<std::uint32_t> found;
    tree.find(segment, found);
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      const Vec3f size = boxes[i].size();
      const GridTraversal walk((segment.ray.origin - boxes[i].lower) / size,
                               segment.ray.direction / size, {1, 1, 1}, segment.t_begin,
                               segment.t_end);
      if (!walk.done()) {
        ++hits;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << ray;
      }
    }
    EXPECT_LT(found.size(), 60u);
  }
  EXPECT_GT(hits, 500u);
}

/// A thousand copies share their values, and each ray has the optical depth that a search of all of
/// them gives, bit for bit.
TEST(VolumeTree, ChangesNoOpticalDepth) {
  const World world = copies(1000).world();
  ASSERT_TRUE(world.medium.tree);
  Medium plain = world.medium;
  plain.tree = nullptr;
  const World one = copies(1).world();
  EXPECT_LT(world.medium.bytes(), 2 * one.medium.bytes() + 100000);
  Rng rng({}, RngStage::test, 2);
  std::size_t met = 0;
  for (int ray = 0; ray < 200; ++ray) {
    const Segment segment = world.medium.clip(line(rng));
    if (segment.empty())
      continue;
    const Rgb tr = exact_transmittance(world.medium, segment);
    EXPECT_EQ(tr, exact_transmittance(plain, segment));
    DepthProfile profile, all;
    profile.build(world.medium, segment, 1e-6f);
    all.build(plain, segment, 1e-6f);
    ASSERT_EQ(profile.knots(), all.knots());
    EXPECT_EQ(profile.met(), all.met());
    if (profile.empty())
      continue;
    met += profile.volume_count();
    EXPECT_EQ(profile.total(profile.knots() - 1), all.total(all.knots() - 1));
    EXPECT_NEAR(std::exp(-profile.total(profile.knots() - 1)), tr.x, 1e-4);
  }
  EXPECT_GT(met, 200u);
}

TEST(VolumeTree, TrackersCollideAsOften) {
  const World world = copies(1000).world();
  Rng rng({}, RngStage::test, 3);
  Samples difference;
  for (int ray = 0; ray < 20000; ++ray) {
    const Segment segment = world.medium.clip(line(rng));
    if (segment.empty())
      continue;
    MediumTracker tracker(world.medium, segment);
    double left = 1; // by ratio tracking
    for (Collision hit = tracker.next(rng); hit.volume; hit = tracker.next(rng))
      left *= 1 - static_cast<double>(hit.sigma_t / hit.majorant);
    difference.add(left - static_cast<double>(exact_transmittance(world.medium, segment).x));
  }
  test::expect_mean(difference, 0);
  test::expect_power(difference, 0.005);
}

/// All estimators agree on a thousand clouds, with a forward peak too.
TEST(VolumeTree, EstimatorsAgree) {
  MemoryScene scene = copies(1000);
  for (std::size_t i = 0; i < scene.scene.volumes.size(); ++i) {
    scene.scene.volumes[i].albedo = Rgb(i % 2 == 0 ? 0.9f : 0.5f);
    scene.scene.volumes[i].phase = test::henyey_greenstein(i % 3 == 0 ? 0.8 : 0);
  }
  scene.add_light(LightType::distant).direction = {0.5, -1, -0.4};
  scene.scene.render.photons = 20000;
  scene.look({0.5, 0.6, 5}, {0, 0, 0}, 26, 8, 8);
  const test::PassMeans truth = test::render_passes(scene, EstimatorType::path, 32);
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::gather, EstimatorType::march}) {
    const test::PassMeans means = test::render_passes(scene, type, 4);
    test::expect_same_mean(means.total[0], truth.total[0], 0.03 * truth.total[0].mean());
  }
  test::expect_power(truth.total[0], 0.03 * truth.total[0].mean());
}

} // namespace
} // namespace vdbeam
