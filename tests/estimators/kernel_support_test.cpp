// How kernels of photons end at surfaces: without leaks, and no smaller than they have to be.
#include "support/fog_scene.h"
#include "support/surface_scene.h"
#include "support/test_frame.h"

#include "photons/clear_kernel.h"
#include "photons/kernel_support.h"
#include "tuning/constants.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;
using namespace test::surfaces;

/// Fog over and under the plane z = 0, seen from above at a slope of one in two.
MemoryScene fog_around_plane() {
  MemoryScene scene;
  add_fog(scene, fog(VolumeShape::box, Vec3d(-4), Vec3d(4), 0.1));
  scene.add_light(LightType::distant);
  scene.look({0, -20, 10}, {0, 0, 0}, 40, 32, 32);
  return scene;
}

/// Turns what lies in the plane z = 0 into the plane x = 0.
constexpr Transform upright{0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0};

class KernelSupportTest : public ::testing::Test {
protected:
  /// The kernel of a photon, of radius 1 before, in scene units.
  Kernel kernel(const Vec3d& photon, KernelDomain domain = KernelDomain::disc) {
    const TestFrame frame(scene_);
    const RenderSpace& space = frame.world.space;
    const EstimatorInput input = frame.input();
    const Vec3f position(space.point(photon));
    Kernel fitted =
        KernelSupport(input, domain, true).fit(position, 0, static_cast<float>(space.scale));
    fitted.radius /= static_cast<float>(space.scale);
    return fitted;
  }

  MemoryScene scene_ = fog_around_plane();
};

/// The camera sees no more of a disc that the ground cuts than the photon does.
TEST_F(KernelSupportTest, GroundCutsDiscs) {
  add_surface(scene_, SurfaceShape::plane, scaled(1), diffuse(0.5));
  const Kernel near = kernel({0.1, 0, 0.02});
  EXPECT_FLOAT_EQ(near.radius, tuning::least_disc_before_surface);
  EXPECT_EQ(near.weight, 1);
  EXPECT_GE(near.share, 0.5f);
  EXPECT_LE(near.share, 0.75f);
  const Kernel farther = kernel({0.1, 0, 0.8}), law = clear_kernel(1, 0.8f);
  EXPECT_NEAR(farther.radius, law.radius, 1e-4f);
  EXPECT_NEAR(farther.weight, law.weight, 1e-3f);
  EXPECT_EQ(farther.share, 1);
  const Kernel free = kernel({0.1, 0, 3.5});
  EXPECT_FLOAT_EQ(free.radius, 1);
}

/// Balls are what walks look at from any side, so they end before the ground.
TEST_F(KernelSupportTest, GroundShrinksBalls) {
  add_surface(scene_, SurfaceShape::plane, scaled(1), diffuse(0.5));
  EXPECT_LT(kernel({0.1, 0, 0.2}, KernelDomain::ball).radius, 0.2f);
}

/// Behind a card that stands upright and along the view the camera sees fog that the photon does
/// not see; behind glass it sees fog too.
TEST_F(KernelSupportTest, DiscsEndBeforeThinCardsAndGlass) {
  add_surface(scene_, SurfaceShape::disk, upright, diffuse(0.5));
  EXPECT_LT(kernel({0.1, 0, 0}).radius, 0.1f);
  scene_.scene.surfaces.clear();
  add_surface(scene_, SurfaceShape::plane, scaled(1), glass());
  EXPECT_LT(kernel({0.1, 0, 0.1}).radius, 0.1f);
}

/// What fits beside a card that hides fog from the photon is taken: half the least disc here.
TEST_F(KernelSupportTest, DiscsShrinkUntilNothingLeaks) {
  add_surface(scene_, SurfaceShape::plane, scaled(1), diffuse(0.5));
  add_surface(scene_, SurfaceShape::disk, upright, diffuse(0.5));
  EXPECT_FLOAT_EQ(kernel({0.8, 0, 0.02}).radius, tuning::least_disc_before_surface);
  EXPECT_FLOAT_EQ(kernel({0.4, 0, 0.02}).radius, tuning::least_disc_before_surface / 2);
}

/// A photon close to the camera, over the ground: it shows in rays of very different directions,
/// but only where both see the fog.
TEST_F(KernelSupportTest, DiscsNearTheCamera) {
  add_surface(scene_, SurfaceShape::plane, scaled(1), diffuse(0.5));
  scene_.look({-0.1, 0, 0.5}, {-0.1, 1, 0.5}, 60, 32, 32);
  const Vec3d photon{0, 0.6, 0.1};
  EXPECT_FLOAT_EQ(kernel(photon).radius, tuning::least_disc_before_surface);
  // The camera sees both sides of a card on edge, the photon sees one.
  Transform card = upright;
  for (double& value : card)
    value *= 0.3;
  add_surface(scene_, SurfaceShape::disk, moved(card, {-0.1, 0.6, 0.1}), diffuse(0.5));
  EXPECT_LT(kernel(photon).radius, 0.1f);
}

} // namespace
} // namespace vdbeam
