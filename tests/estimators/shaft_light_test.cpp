// Where surfaces hide a light from parts of a ray, which then takes more shadow rays.
#include "support/fog_scene.h"
#include "support/surface_scene.h"
#include "support/test_frame.h"

#include "rays/shaft_light.h"
#include "transport/camera_ray.h"
#include "tuning/constants.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;
using namespace test::surfaces;

class ShaftLightTest : public ::testing::Test {
protected:
  /// Thin fog, the sun straight above it, and a ray through its middle.
  ShaftLightTest() {
    add_fog(scene_, fog(VolumeShape::box, Vec3d(-1), Vec3d(1), 1e-3));
    scene_.add_light(LightType::distant).direction = {0, 0, -1};
    scene_.look({0, -8, 0}, {0, 0, 0}, 5, 1, 1);
    add_surface(scene_, SurfaceShape::sphere, moved(scaled(0.01), {3, 0, 0}), diffuse(0.5));
  }

  /// A card in the plane z = 2 from y = `begin` to y = `begin` + 4, in the sun's way.
  void hide_from(double begin) {
    add_surface(scene_, SurfaceShape::quad, moved(scaled(2), {0, begin + 2, 2}), diffuse(0.5));
  }

  /// Sums over rays like that of the picture.
  ShaftLight sums() {
    const TestFrame frame(scene_);
    const CameraRay camera = camera_ray(frame.world, frame.camera, frame.camera.ray(0.5, 0.52));
    DepthProfile profile;
    profile.build(frame.world.medium, camera.segment, 1e-6f);
    ShaftLight sum;
    for (std::uint64_t i = 0; i < rays; ++i) {
      Rng rng({1, 1, 1}, RngStage::shaft_light, i);
      sum += look_for_shafts(frame.world, camera.ray(), profile, {true}, rng);
    }
    return sum;
  }

  static constexpr std::uint64_t rays = 4096;
  MemoryScene scene_;
};

TEST_F(ShaftLightTest, LightInFullSight) {
  const ShaftLight sum = sums();
  EXPECT_EQ(sum.rays, rays);
  EXPECT_GT(sum.light, 0);
  EXPECT_NEAR(sum.variance, 0, 1e-6f * sum.light);
  EXPECT_EQ(sum.effort(0), 1);
}

/// A share p of the points has the light L, the others are hidden and have none: mean p L, variance
/// p (1 - p) L^2.
TEST_F(ShaftLightTest, LightHiddenFromAPart) {
  const float whole = sums().light / rays;
  for (const float share : {0.5f, 0.1f}) {
    scene_.scene.surfaces.resize(1);
    hide_from(static_cast<double>(2 * share - 1));
    const ShaftLight sum = sums();
    const float deviation = std::sqrt(share * (1 - share)); // of a point
    // Five standard errors of the means over 2 and 1 points of each ray.
    EXPECT_NEAR(sum.light / rays, share * whole, 5 * deviation * whole / std::sqrt(2.0f * rays));
    EXPECT_NEAR(sum.variance / rays, deviation * deviation * whole * whole,
                5 * deviation * whole * whole / std::sqrt(4.0f * rays));
    EXPECT_NEAR(sum.effort(0), tuning::effort_in_shafts * deviation / share, 0.1f * sum.effort(0));
    EXPECT_EQ(sum.effort(100 * whole), 1) << "what lies behind outshines it";
  }
}

} // namespace
} // namespace vdbeam
