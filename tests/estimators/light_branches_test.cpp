// Walks of the path tracer that branch towards narrow lights: the picture is the same, with less
// noise where a phase function has a sharp peak.
#include "walks/light_branches.h"

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
  MemoryScene scene = lit_by_two_suns(henyey_greenstein(0.93));
  scene.add_light(LightType::point).position = {0.2, 0.6, 0.3};
  const TestFrame frame(scene);
  const World& world = frame.world;
  const LampShells shells(world, {true, true, true, true});
  const LightBranches branches(world, {true, true, true, true}, shells);
  ASSERT_TRUE(branches.any());
  const PhaseFunction& phase = world.medium.phases[0];
  const Vec3f point{0.1f, -0.2f, 0.05f};
  const LightBranches::Vertex vertex = branches.at(point);
  const Vec3f to_lamp(normalize(*world.lights[3].position() - Vec3d(point)));
  Rng rng({}, RngStage::test, 1);
  // The mean over scatterings of 1/density of a branch in a cone is the cone's solid angle.
  for (const Vec3f& towards :
       {*world.lights[0].narrow_direction(), *world.lights[1].narrow_direction(), to_lamp}) {
    for (const float cosine : {0.9999f, 0.98f}) {
      Samples cone;
      for (int i = 0; i < 1000000; ++i) {
        const std::optional<Vec3f> branch = vertex.sample(phase, rng);
        const bool inside = branch && dot(*branch, towards) > cosine;
        cone.add(inside ? 1 / static_cast<double>(vertex.density(phase, *branch)) : 0);
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
  const LampShells of_sharp(sharp_world, {true, true, true}),
      of_blunt(blunt_world, {true, true, true});
  EXPECT_TRUE(LightBranches(sharp_world, {true, true, true}, of_sharp).any());
  EXPECT_FALSE(LightBranches(blunt_world, {true, true, true}, of_blunt).any());
  const LightBranches none(sharp_world, {false, false, true}, of_sharp);
  EXPECT_FALSE(none.any());
  EXPECT_EQ(none.at({}).importance({0, 0, 1}), 1);
  EXPECT_EQ(none.at({}).density(sharp_world.medium.phases[0], {0, 0, 1}), 0);
}

/// About a lamp in the medium branches have their density, whatever the phase function; far from it
/// there are none.
TEST(LightBranches, PassLampsInTheMedium) {
  MemoryScene scene = lit_by_two_suns(henyey_greenstein(0.6));
  scene.scene.volumes[0].extinction = 100;
  scene.add_light(LightType::point).position = {0.1, 0.1, 0.1};
  const TestFrame frame(scene);
  const World& world = frame.world;
  const std::vector<bool> sampled(4, true);
  const LampShells shells(world, sampled);
  const LightBranches branches(world, sampled, shells);
  const PhaseFunction& phase = world.medium.phases[0];
  const Vec3d lamp = *world.lights[3].position();
  const double radius = shells.radius_of(3);
  ASSERT_GT(radius, 0);
  const Vec3f near(lamp + Vec3d(2 * radius, 0, 0)), far(lamp + Vec3d(20 * radius, 0, 0));
  Rng rng({}, RngStage::test, 2);
  for (const double angle : {0.001, 0.1, 1.0}) {
    Samples cone;
    for (int i = 0; i < 1000000; ++i) {
      const std::optional<Vec3f> branch = branches.at(near).sample(phase, rng);
      const bool inside =
          branch && length(cross(*branch, Vec3f(-1, 0, 0))) < static_cast<float>(std::sin(angle)) &&
          branch->x < 0;
      cone.add(inside ? 1 / static_cast<double>(branches.at(near).density(phase, *branch)) : 0);
    }
    expect_mean(cone, 2 * std::numbers::pi * (1 - std::cos(angle)));
  }
  EXPECT_EQ(branches.at(far).density(phase, {-1, 0, 0}), 0);
  EXPECT_FALSE(branches.at(far).sample(phase, rng));
}

/// Walks branch towards lamps in and near the medium: `path` has little noise, and shows what
/// photons show. The camera looks past the lamps.
TEST(LightBranches, FindTheLightOfLamps) {
  // Without branches the errors are 0.15 and 0.06 of the means.
  for (const auto& [g, most] : {std::pair(0.97, 0.12), std::pair(0.0, 0.03)}) {
    MemoryScene scene = lit_by_two_suns(henyey_greenstein(g));
    scene.look({0.4, 0.3, 3}, {-0.2, -0.2, 0}, 8, 16, 16);
    scene.scene.lights.clear();
    for (const Vec3d& position : {Vec3d(0.1, 0.15, -0.2), Vec3d(-0.5, 0.9, -0.6)}) {
      LightSettings& lamp = scene.add_light(LightType::point);
      lamp.position = position;
      lamp.intensity = {1, 0.8f, 0.5f};
    }
    const PassMeans path = render_passes(scene, EstimatorType::path, 60);
    const PassMeans beam = render_passes(scene, EstimatorType::beam, 60);
    for (std::size_t c = 0; c < 3; ++c) {
      expect_same_mean(path.indirect[c], beam.indirect[c]);
      EXPECT_LT(path.indirect[c].error(), most * path.indirect[c].mean()) << g;
    }
  }
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
