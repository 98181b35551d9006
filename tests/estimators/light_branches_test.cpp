// Walks of the path tracer that branch towards narrow lights: the picture is the same, with less
// noise where a phase function has a sharp peak.
#include "estimators/path/light_branches.h"

#include "support/render_passes.h"
#include "support/surface_scene.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;
using namespace test::surfaces;

/// A cube of lumps in a low sun and another from the side, the first wide enough to be met.
MemoryScene lit_by_two_suns(const PhaseSettings& phase) {
  MemoryScene scene;
  const DensityField field = closed_field(
      {8, 8, 8}, [](int i, int j, int k) { return 0.5 + lattice_noise(i / 4, j / 4, k / 4); });
  VolumeSettings& volume = scene.add(field, box_map({8, 8, 8}, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 8;
  volume.albedo = {0.999f, 0.95f, 0.9f};
  volume.phase = phase;
  LightSettings& low = scene.add_light(LightType::distant);
  low.direction = {0.6, -0.1, 1};
  low.angular_radius = 0.8;
  scene.add_light(LightType::distant).direction = {-1, -0.3, 0.2};
  scene.add_light(LightType::environment).radiance = {0.03f, 0.05f, 0.1f};
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 16, 16);
  return scene;
}

TEST(LightBranches, HaveTheirDensity) {
  const MemoryScene scene = lit_by_two_suns(henyey_greenstein(0.93));
  const TestFrame frame(scene);
  const World& world = frame.world;
  const LightBranches branches(world, {true, true, true});
  ASSERT_TRUE(branches.any());
  const PhaseFunction& phase = world.medium.phases[0];
  Rng rng({}, RngStage::test, 1);
  // The mean over scatterings of 1/density of a branch in a cone is the cone's solid angle.
  for (const std::size_t light : {0u, 1u}) {
    const Vec3f& towards = *world.lights[light].narrow_direction();
    for (const float cosine : {0.9999f, 0.98f}) {
      Samples cone;
      for (int i = 0; i < 1000000; ++i) {
        const std::optional<Vec3f> branch = branches.sample(phase, rng);
        const bool inside = branch && dot(*branch, towards) > cosine;
        cone.add(inside ? 1 / static_cast<double>(branches.density(phase, *branch)) : 0);
      }
      expect_mean(cone, 2 * std::numbers::pi * (1 - static_cast<double>(cosine)));
      EXPECT_LT(cone.error(), 0.03 * cone.mean());
    }
  }
}

/// Only where they help: a sharp peak, a narrow light, and a shadow ray to it.
TEST(LightBranches, AreLeftOutElsewhere) {
  const MemoryScene sharp = lit_by_two_suns(henyey_greenstein(0.93)),
                    blunt = lit_by_two_suns(henyey_greenstein(0.6));
  const World sharp_world = sharp.world(), blunt_world = blunt.world();
  EXPECT_TRUE(LightBranches(sharp_world, {true, true, true}).any());
  EXPECT_FALSE(LightBranches(blunt_world, {true, true, true}).any());
  const LightBranches none(sharp_world, {false, false, true});
  EXPECT_FALSE(none.any());
  EXPECT_EQ(none.importance({0, 0, 1}), 1);
  EXPECT_EQ(none.density(sharp_world.medium.phases[0], {0, 0, 1}), 0);
}

/// Walks among surfaces branch as those in the open do: with a black ball behind the camera `path`
/// shows the same picture, with as little noise.
TEST(LightBranches, AreThereAmongSurfacesToo) {
  MemoryScene scene = lit_by_two_suns(henyey_greenstein(0.93));
  const PassMeans open = render_passes(scene, EstimatorType::path, 60);
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.1), {0, 0, 20}), diffuse(0));
  const PassMeans among = render_passes(scene, EstimatorType::path, 60);
  for (std::size_t c = 0; c < 3; ++c) {
    expect_same_mean(open.indirect[c], among.indirect[c]);
    EXPECT_LT(open.indirect[c].error(), 0.01 * open.indirect[c].mean());
    EXPECT_LT(among.indirect[c].error(), 0.01 * among.indirect[c].mean());
  }
  EXPECT_EQ(regions_apart(open, among, 0), 0);
}

} // namespace
} // namespace vdbeam
