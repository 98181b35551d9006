#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

// Kirchhoff's law: a medium of one temperature in a cavity of that temperature is invisible. With
// absorption sigma_a = (1 - albedo) sigma_t, emission sigma_a B, and radiance B from everywhere,
// every ray sees exactly B, however deep the medium is and however it scatters.
namespace vdbeam {
namespace {

using test::MemoryScene;

struct Equilibrium {
  double depth, g, albedo;
  bool lumpy;

  friend std::ostream& operator<<(std::ostream& out, const Equilibrium& e) {
    return out << (e.lumpy ? "lumpy, depth " : "even, depth ") << e.depth << ", g " << e.g
               << ", albedo " << e.albedo;
  }
};

constexpr float radiance = 3;

DensityField make_field(bool lumpy, const Vec3<int>& cells) {
  if (!lumpy)
    return test::uniform_field(cells, 1);
  return test::closed_field(cells, [](int i, int j, int k) {
    const double u = test::lattice_noise(i, j, k);
    return u < 0.3 ? 0.1 : 3 * u * u;
  });
}

MemoryScene cavity(const Equilibrium& e) {
  MemoryScene scene;
  const Vec3<int> cells{2, 2, 2};
  const Affine map = test::box_map(cells, Vec3d(-0.5), Vec3d(0.5));
  scene.add(make_field(e.lumpy, cells), map);
  scene.glow(make_field(e.lumpy, cells), map);
  VolumeSettings& volume = scene.scene.volumes[0];
  volume.extinction = e.depth;
  volume.albedo = Rgb(static_cast<float>(e.albedo));
  volume.phase = test::henyey_greenstein(e.g);
  volume.emission.scale = (1 - static_cast<double>(volume.albedo.x)) * e.depth * radiance;
  scene.add_light(LightType::environment).radiance = Rgb(radiance);
  scene.look({0.9, 0.7, 2.6}, {0, 0, 0}, 40, 8, 8);
  return scene;
}

/// Everything is `radiance` up to 4 standard errors and a bias, and the medium has its part in it.
void expect_invisible(const MemoryScene& scene, EstimatorType type, int passes, double error_limit,
                      double bias) {
  const test::PassMeans means = test::render_passes(scene, type, passes);
  for (std::size_t c = 0; c < 3; ++c)
    test::expect_mean(means.total[c], radiance, bias * radiance, 2e-5);
  EXPECT_LT(means.total[0].error(), error_limit * radiance);
}

class ThermalEquilibrium : public testing::TestWithParam<Equilibrium> {};

TEST_P(ThermalEquilibrium, Path) {
  expect_invisible(cavity(GetParam()), EstimatorType::path, 12, 4e-3, 0);
}

/// A probe along the normal of a face, through its middle, so that no kernel reaches out of the
/// medium sideways (see furnace_test.cpp).
MemoryScene probe(const Equilibrium& e) {
  MemoryScene scene = cavity(e);
  scene.look({0, 0, 2000}, {0, 0, 0}, 0.001, 4, 4);
  RenderSettings& render = scene.scene.render;
  render.photons = e.depth < 100 ? 20000 : 100000; // of short paths, where most is absorbed
  render.thinning = PhotonThinning::even;
  render.kernel = KernelRadius::fixed;
  render.radius = 0.25;
  render.alpha = 1;
  render.step = 0.5;
  return scene;
}

TEST_P(ThermalEquilibrium, Beam) {
  expect_invisible(probe(GetParam()), EstimatorType::beam, 12, 0.04, 0);
}

TEST_P(ThermalEquilibrium, March) {
  MemoryScene scene = probe(GetParam());
  scene.scene.render.radius = 0.1;
  // Ball kernels reach out of the two faces: at most half of what is scattered within a radius of
  // them; the correction leaves at most a quarter.
  const double scattered = GetParam().albedo * std::min(1.0, GetParam().depth);
  expect_invisible(scene, EstimatorType::march, 24, 0.06, 2 * 0.1 * 0.5 * 0.25 * scattered);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ThermalEquilibrium,
    testing::Values(Equilibrium{0.1, 0, 0.5, false}, Equilibrium{1, 0.8, 0.8, false},
                    Equilibrium{1, 0, 0.3, true}, Equilibrium{10, 0, 0.9, true},
                    Equilibrium{10, 0.8, 0.5, false}, Equilibrium{100, 0, 0.7, true},
                    Equilibrium{100, 0.8, 0.5, false}, Equilibrium{10, 0, 0, true}));

// Each channel has its own optical depth; emission follows, so the law holds in each.
TEST(ThermalEquilibriumOfColours, ChromaticExtinction) {
  MemoryScene scene = cavity({5, 0.3, 0.6, true});
  VolumeSettings& volume = scene.scene.volumes[0];
  volume.extinction_scale = volume.emission.color = {1, 0.3f, 0.05f};
  expect_invisible(scene, EstimatorType::path, 48, 0.01, 0);
  MemoryScene inside = probe({5, 0.3, 0.6, false});
  inside.scene.volumes[0].extinction_scale =
      inside.scene.volumes[0].emission.color = {1, 0.3f, 0.05f};
  expect_invisible(inside, EstimatorType::beam, 16, 0.04, 0);
}

TEST(ThermalEquilibriumOfColours, AlbedoOfEachChannel) {
  MemoryScene scene = cavity({5, 0, 0, true});
  VolumeSettings& volume = scene.scene.volumes[0];
  volume.albedo = {0.9f, 0.5f, 0};
  volume.emission.scale = 5 * radiance;
  volume.emission.color = Rgb(1) - volume.albedo;
  expect_invisible(scene, EstimatorType::path, 24, 0.01, 0);
}

/// Two media of one temperature, one turned against the other, and the camera among them.
TEST(ThermalEquilibriumOfColours, OverlapFromWithin) {
  MemoryScene scene = cavity({4, 0.5, 0.7, true});
  const Vec3<int> cells{1, 1, 1};
  const Affine map = test::turn({1, 1, 0}, 30).after(test::box_map(cells, Vec3d(-0.3), Vec3d(0.6)));
  VolumeSettings& second = scene.add(test::uniform_field(cells, 1), map);
  second.extinction = 3;
  second.albedo = Rgb(0.25f);
  scene.glow(test::uniform_field(cells, 1), map).scale = 0.75 * 3 * radiance;
  scene.look({0.1, 0.2, 0.15}, {0, 0, -2}, 90, 8, 8);
  expect_invisible(scene, EstimatorType::path, 24, 0.01, 0);
}

} // namespace
} // namespace vdbeam
