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

TEST(LightSet, AddsUpWhatEscapes) {
  LightSettings sun;
  sun.angular_radius = 10;
  sun.direction = {0, -1, 0};
  sun.direct = DirectLight::photons;
  const OccupiedRegion region = region_of({cube({}, 1)});
  const LightSet lights({sky(1), sun, sky(2)}, {0, 1, 0}, RenderSpace{}, region);
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_FLOAT_EQ(lights.escaped_radiance({0, -1, 0}).x, 3);
  EXPECT_GT(lights.escaped_radiance({0, 1, 0}).x, 10);
  EXPECT_EQ(lights[0].direct, DirectLight::automatic);
  EXPECT_EQ(lights[1].direct, DirectLight::photons);
  EXPECT_EQ(lights[1].type(), LightType::distant);
}

TEST(LightSet, MissingImageIsAnInputError) {
  LightSettings settings = sky(1);
  settings.image = "/nonexistent/sky.exr";
  EXPECT_THROW(LightSet({settings}, {0, 1, 0}, RenderSpace{}, OccupiedRegion{}), InputError);
}

} // namespace
} // namespace vdbeam
