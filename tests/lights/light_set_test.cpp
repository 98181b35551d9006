#include "lights/light_set.h"
#include "lights/light_test_scene.h"
#include "vdbeam/error.h"

namespace vdbeam {
namespace {

using namespace test;

LightSettings sky(float radiance) {
  LightSettings settings;
  settings.type = LightType::environment;
  settings.radiance = Rgb(radiance);
  return settings;
}

float sum_of(const LightSet& lights, const Vec3f& direction) {
  float sum = 0;
  for (std::size_t i = 0; i < lights.size(); ++i)
    sum += escaped_radiance(lights[i], direction).x;
  return sum;
}

TEST(LightSet, HoldsAllLightsAndTheirPolicies) {
  LightSettings sun;
  sun.angular_radius = 10;
  sun.direction = {0, -1, 0};
  const OccupiedRegion region = region_of({cube({}, 1)});
  const LightSet lights({sky(1), sun, sky(2)}, {0, 1, 0}, RenderSpace{}, region);
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_FLOAT_EQ(sum_of(lights, {0, -1, 0}), 3);
  EXPECT_GT(sum_of(lights, {0, 1, 0}), 10);
}

TEST(LightSet, UnknownKindIsAnInputError) {
  LightSettings settings;
  settings.type = {"lantern"};
  EXPECT_THROW(LightSet({settings}, {0, 1, 0}, RenderSpace{}, OccupiedRegion{}), InputError);
}

TEST(LightSet, HiddenLightsLightButDoNotShow) {
  LightSettings hidden = sky(2);
  hidden.visible = false;
  const OccupiedRegion region = region_of({cube({}, 1)});
  const LightSet lights({sky(1), hidden}, {0, 1, 0}, RenderSpace{}, region);
  EXPECT_TRUE(lights.traits(0).visible);
  EXPECT_FALSE(lights.traits(1).visible);
  EXPECT_FLOAT_EQ(escaped_radiance(lights[1], {0, 1, 0}).x, 2);
  EXPECT_GT(lights[1].power().x, 0);
}

TEST(LightSet, MissingImageIsAnInputError) {
  LightSettings settings = sky(1);
  settings.image = "/nonexistent/sky.exr";
  EXPECT_THROW(LightSet({settings}, {0, 1, 0}, RenderSpace{}, OccupiedRegion{}), InputError);
}

} // namespace
} // namespace vdbeam
