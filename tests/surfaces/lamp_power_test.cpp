// Lamps given by their power, temperature and exposure.
#include "support/surface_test.h"
#include "volume/blackbody.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

/// A lamp of a given power shines with power / (pi area), whatever its shape and the scene's scale.
TEST(LampPower, IsRadianceOverAllOfTheSurface) {
  struct Case {
    SurfaceShape shape;
    Transform at;
    bool two_sided;
    double area;
  };
  for (const Case& c : {Case{SurfaceShape::sphere, scaled(0.2), false, 4 * M_PI * 0.04},
                        Case{SurfaceShape::quad, {3, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 9}, true, 6},
                        Case{SurfaceShape::disk, scaled(40), false, M_PI * 1600}}) {
    MemoryScene scene;
    MaterialSettings lamp = of_type(MaterialType::emissive);
    lamp.power = Rgb(60, 30, 15);
    lamp.two_sided = c.two_sided;
    lamp.kelvin = 2700;
    lamp.exposure = 1;
    add_surface(scene, c.shape, c.at, lamp);
    scene.add_box(Vec3d(-7), Vec3d(7)).extinction = 0.1;
    const World world = scene.world();
    EXPECT_NE(world.space.scale, 1);
    const Rgb tint = light_tint(2700.0, 1, ColorSpace::rec709);
    const Rgb emitted = world.surfaces->materials[0]->emitted(true);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(emitted[i] * M_PI * c.area * (c.two_sided ? 2 : 1), (*lamp.power)[i] * tint[i],
                  1e-5 * (*lamp.power)[i] * tint[i]);
  }
}

/// A white room around a lamp: what it sends out is what a hole lets out, so the walls' radiance
/// follows from the power alone. Here: the irradiance of a far wall below a small ball of light.
TEST(LampPower, OfABallIsThatOfAPoint) {
  MemoryScene ball, point;
  MaterialSettings lamp = of_type(MaterialType::emissive);
  lamp.power = Rgb(100);
  add_surface(ball, SurfaceShape::sphere, moved(scaled(0.05), {0, 0, 3}), lamp);
  LightSettings& light = point.add_light(LightType::point);
  light.position = {0, 0, 3};
  light.power = Rgb(100);
  for (MemoryScene* scene : {&ball, &point}) {
    add_surface(*scene, SurfaceShape::quad, scaled(1), diffuse(0.5));
    scene->look({0, 4, 4}, {0, 0, 0}, 10, 8, 8);
  }
  const PassMeans a = render_passes(ball, EstimatorType::path, 64),
                  b = render_passes(point, EstimatorType::path, 64);
  expect_power(a.total[0], 0.005 * a.total[0].mean());
  expect_same_mean(a.total[0], b.total[0], 0.002 * b.total[0].mean());
}

} // namespace
} // namespace vdbeam
