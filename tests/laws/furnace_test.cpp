#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

// White furnace: where nothing is absorbed and radiance 1 comes from everywhere, everything has
// radiance 1.
namespace vdbeam {
namespace {

using test::MemoryScene;

/// A box of `depth` mean free paths along the view, seen whole from outside.
MemoryScene furnace(DensityField field, const Vec3<int>& cells, double depth) {
  MemoryScene scene;
  scene.add(std::move(field), test::box_map(cells, Vec3d(-0.5), Vec3d(0.5))).extinction = depth;
  scene.add_light(LightType::environment);
  scene.look({0.9, 0.7, 2.6}, {0, 0, 0}, 40, 10, 10);
  return scene;
}

MemoryScene homogeneous(double depth) {
  return furnace(test::uniform_field({1, 1, 1}, 1), {1, 1, 1}, depth);
}

/// Blobs with empty and dense voxels next to each other; the mean density is about 1.
MemoryScene heterogeneous(double depth) {
  const Vec3<int> cells{2, 2, 2};
  const auto value = [](int i, int j, int k) {
    const double u = test::lattice_noise(i, j, k);
    return i == 0 || j == 0 || u < 0.4 ? 0.0 : 5 * u * u;
  };
  return furnace(test::closed_field(cells, value), cells, depth);
}

void expect_one(const test::PassMeans& means, double bias = 0) {
  for (std::size_t c = 0; c < 3; ++c)
    test::expect_mean(means.total[c], 1, bias);
}

void expect_white(const MemoryScene& scene, int passes, double error_limit) {
  const test::PassMeans means = test::render_passes(scene, EstimatorType::path, passes);
  expect_one(means);
  // Power: had light got lost, it would show.
  EXPECT_LT(means.total[0].error(), error_limit);
}

class PathFurnace : public testing::TestWithParam<double> {};

TEST_P(PathFurnace, Homogeneous) {
  for (const double depth : {0.1, 1.0, 10.0, 100.0}) {
    SCOPED_TRACE(depth);
    MemoryScene scene = homogeneous(depth);
    scene.scene.volumes[0].phase = test::henyey_greenstein(GetParam());
    expect_white(scene, 8, 1e-3);
  }
}

TEST_P(PathFurnace, Heterogeneous) {
  for (const double depth : {0.1, 1.0, 10.0, 100.0}) {
    SCOPED_TRACE(depth);
    MemoryScene scene = heterogeneous(depth);
    scene.scene.volumes[0].phase = test::henyey_greenstein(GetParam());
    expect_white(scene, 16, 3e-3);
  }
}

TEST_P(PathFurnace, OpticalDepthOfAThousand) {
  for (MemoryScene scene : {homogeneous(1000), heterogeneous(1000)}) {
    scene.scene.volumes[0].phase = test::henyey_greenstein(GetParam());
    scene.scene.image = {4, 4};
    expect_white(scene, 40, 1e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(MeanCosine, PathFurnace, testing::Values(-0.9, 0.0, 0.6, 0.95));

TEST(PathFurnaceColour, ChromaticExtinction) {
  for (const double depth : {1.0, 30.0}) {
    SCOPED_TRACE(depth);
    MemoryScene scene = heterogeneous(depth);
    scene.scene.volumes[0].extinction_scale = {1, 0.3f, 0.05f};
    expect_white(scene, 64, 1e-2);
  }
}

TEST(PathFurnaceColour, OverlappingVolumes) {
  MemoryScene scene = heterogeneous(5);
  scene.scene.volumes[0].extinction_scale = {1, 0.3f, 0.05f};
  VolumeSettings& second =
      scene.add(test::uniform_field({1, 1, 1}, 1),
                test::turn({1, 1, 0}, 30).after(test::box_map({1, 1, 1}, Vec3d(-0.3), Vec3d(0.4))));
  second.extinction = 4;
  second.phase = test::henyey_greenstein(0.8);
  expect_white(scene, 64, 1e-2);
}

TEST(PathFurnaceColour, CameraInsideTheMedium) {
  MemoryScene scene = heterogeneous(20);
  scene.look({0.1, 0.2, 0.15}, {0, 0, -2}, 90, 10, 10);
  expect_white(scene, 16, 1e-2);
}

TEST(PathFurnaceColour, TwoSkiesAddUp) {
  MemoryScene scene = heterogeneous(10);
  scene.scene.lights[0].radiance = {0.25f, 0.5f, 1};
  scene.add_light(LightType::environment).radiance = {0.75f, 0.5f, 0};
  expect_white(scene, 16, 3e-3);
}

// Photons. In a furnace the fluence is 4 pi everywhere, so a beam estimate is wrong only where a
// kernel reaches out of the medium, where no photons are. Seen along the normal of a face, through
// its middle, a disc kernel never does: no bias at all. A ball kernel does within a radius of the
// two faces; what the share of its support does not make up for is declared as bias.
struct PhotonFurnace {
  double depth, g;
  double power = 0.02; ///< standard errors stay below this
  KernelShape shape = KernelShape::biweight;

  friend std::ostream& operator<<(std::ostream& out, const PhotonFurnace& furnace_settings) {
    return out << "depth " << furnace_settings.depth << " g " << furnace_settings.g;
  }
};

/// A probe of the box's middle: every pixel sees the same.
MemoryScene probe(DensityField field, const Vec3<int>& cells,
                  const PhotonFurnace& furnace_settings) {
  MemoryScene scene = furnace(std::move(field), cells, furnace_settings.depth);
  scene.scene.volumes[0].phase = test::henyey_greenstein(furnace_settings.g);
  scene.look({0, 0, 2000}, {0, 0, 0}, 0.001, 4, 4);
  RenderSettings& render = scene.scene.render;
  render.photons = 20000;
  render.thinning = PhotonThinning::even;
  render.kernel = KernelRadius::fixed;
  render.radius = 0.25;
  render.alpha = 1; // radii stay
  render.kernel_shape = furnace_settings.shape;
  render.step = 0.5;
  return scene;
}

class BeamFurnace : public testing::TestWithParam<PhotonFurnace> {};

TEST_P(BeamFurnace, HasNoBiasInside) {
  const Vec3<int> cells{2, 2, 2};
  const auto noise = [](int i, int j, int k) { return 2 * test::lattice_noise(i, j, k); };
  for (const bool heterogeneous_medium : {false, true}) {
    SCOPED_TRACE(heterogeneous_medium ? "heterogeneous" : "homogeneous");
    MemoryScene scene = heterogeneous_medium
                            ? probe(test::closed_field(cells, noise), cells, GetParam())
                            : probe(test::uniform_field({1, 1, 1}, 1), {1, 1, 1}, GetParam());
    const test::PassMeans means = test::render_passes(scene, EstimatorType::beam, 32);
    expect_one(means);
    EXPECT_LT(means.total[0].error(), GetParam().power);
  }
}

TEST_P(BeamFurnace, MarchToo) {
  MemoryScene scene = probe(test::uniform_field({1, 1, 1}, 1), {1, 1, 1}, GetParam());
  scene.scene.render.radius = 0.15;
  // A ray of unit length loses or gains in two zones of a radius, at most half of the light there,
  // the correction leaves at most a quarter of it.
  const double bias = 2 * 0.15 * 0.5 * 0.25 * std::min(1.0, GetParam().depth);
  const test::PassMeans means = test::render_passes(scene, EstimatorType::march, 24);
  expect_one(means, bias);
  EXPECT_LT(means.total[0].error(), 2 * GetParam().power);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BeamFurnace,
                         testing::Values(PhotonFurnace{0.1, 0, 0.002}, PhotonFurnace{1, -0.9, 0.04},
                                         PhotonFurnace{1, 0.6}, PhotonFurnace{10, 0},
                                         PhotonFurnace{10, 0.95, 0.2},
                                         PhotonFurnace{10, 0, 0.02, KernelShape::constant},
                                         PhotonFurnace{100, 0, 0.06}));

// A thousand mean free paths: few photons, each of a long path. The kernel must not be wide beside
// the skin that a camera sees, or perspective would tilt its support out of it.
TEST(BeamFurnaceKernels, OpticalDepthOfAThousand) {
  MemoryScene scene = probe(test::uniform_field({1, 1, 1}, 1), {1, 1, 1}, {1000, 0, 0.1});
  scene.scene.render.photons = 10000;
  scene.scene.render.thinning = PhotonThinning::even;
  const test::PassMeans means = test::render_passes(scene, EstimatorType::beam, 40);
  expect_one(means);
  EXPECT_LT(means.total[0].error(), 0.1);
}

// At the rim the correction of the kernels' support must carry: the whole box, seen from a corner.
TEST(BeamFurnaceKernels, RimOfTheMedium) {
  for (const EstimatorType estimator : {EstimatorType::beam, EstimatorType::march}) {
    MemoryScene scene = homogeneous(3);
    scene.scene.render.photons = 20000;
    scene.scene.render.kernel = KernelRadius::fixed;
    scene.scene.render.radius = 0.05;
    const test::PassMeans means = test::render_passes(scene, estimator, 24);
    expect_one(means, 0.01);
    EXPECT_LT(means.total[0].error(), 0.005);
  }
}

} // namespace
} // namespace vdbeam
