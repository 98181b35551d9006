#include "estimators/beam/beam_weights.h"

#include "support/memory_scene.h"
#include "support/test_frame.h"
#include "transport/camera_ray.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

/// Along the ray through the middle of a box of 16 x 16 x 16 voxels, two alternating layers
/// with two empty ones: what the table W gathers of light that has the shape of Tr sigma_s itself,
/// relative to the truth.
double gathered_share(double depth_per_voxel) {
  MemoryScene scene;
  const Vec3<int> cells{2, 2, 2};
  VolumeSettings& volume =
      scene.add(closed_field(cells, [](int, int, int k) { return k % 4 < 2 ? 1.0 : 0.0; }),
                box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 16 * depth_per_voxel;
  volume.albedo = Rgb(1);
  scene.look({0.21, 0.13, 3}, {0.21, 0.13, 0}, 1, 1, 1);
  const TestFrame frame(scene);
  const World& world = frame.world;
  const CameraRay ray = camera_ray(world, frame.camera, frame.camera.ray(0.5, 0.5));
  DepthProfile profile;
  profile.build(world.medium, ray.segment, 1e-6f);
  std::vector<float> weights;
  const PhotonMap::RayProfile table = ray_weights(world, ray, profile, {}, weights)[0];
  ProfileCursor cursor(profile);
  double gathered = 0, truth = 0;
  constexpr int steps = 4000;
  const float dt = (profile.back() - profile.front()) / steps;
  float before = profile.tau(0);
  for (int i = 0; i < steps; ++i) {
    const float t = profile.front() + (static_cast<float>(i) + 0.5f) * dt;
    cursor.move_to(t + 0.5f * dt);
    const float tau = cursor.tau(), exact = (std::exp(-before) - std::exp(-tau)) / dt;
    before = tau;
    const float x = (t - table.t_begin) / table.step;
    const int knot = std::clamp(static_cast<int>(x), 0, table.knots - 2);
    const float a = table.weights[knot], b = table.weights[knot + 1];
    const float weight = a + (x - static_cast<float>(knot)) * (b - a);
    gathered += static_cast<double>(weight * exact);
    truth += static_cast<double>(exact * exact);
  }
  return gathered / truth;
}

/// With intervals as long as voxels a sixth of the light would be lost.
TEST(BeamWeights, FollowDensityThatChangesFromVoxelToVoxel) {
  for (const double depth : {0.01, 0.1}) {
    EXPECT_GT(gathered_share(depth), 0.95) << depth;
  }
}

} // namespace
} // namespace vdbeam
