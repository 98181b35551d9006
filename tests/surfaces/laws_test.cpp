#include "support/surface_test.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

void expect_every_pixel(const PassMeans& means, double value, double tolerance) {
  for (std::size_t i = 0; i < means.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(means.pixels[i][c], value, tolerance) << "pixel " << i;
}

/// A constant sky of radiance 1 around a sphere in a box of fog, or in nothing.
MemoryScene furnace(const MaterialSettings& material, bool fog) {
  MemoryScene scene;
  if (fog)
    scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 2;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  add_surface(scene, SurfaceShape::sphere, scaled(0.5), material);
  scene.look({0, 0.3, 4}, {0, 0, 0}, 40, 8, 8);
  return scene;
}

MaterialSettings white_glass(double ior = 1.5) {
  MaterialSettings material = of_type(MaterialType::dielectric);
  material.ior = ior;
  return material;
}

TEST(SurfaceFurnace, mirror_glass_and_white_vanish) {
  for (const MaterialSettings& material :
       {of_type(MaterialType::mirror), white_glass(), white_glass(0.5), white_glass(4), white()}) {
    // In nothing every path brings back 1.
    expect_every_pixel(render_passes(furnace(material, false), EstimatorType::path, 2), 1, 1e-4);
    const PassMeans fog = render_passes(furnace(material, true), EstimatorType::path, 64);
    expect_mean(fog.total[0], 1);
    expect_every_pixel(fog, 1, 0.1);
  }
}

/// A shell without thickness: light goes in and comes out through rough facets.
TEST(SurfaceFurnace, nearly_smooth_rough_glass) {
  MaterialSettings material = white_glass();
  material.roughness = 0.1;
  const PassMeans means = render_passes(furnace(material, true), EstimatorType::path, 64);
  expect_mean(means.total[0], 1, 0.005);
}

TEST(SurfaceFurnace, glass_of_index_1_changes_nothing) {
  MemoryScene scene = furnace(white_glass(1), true);
  scene.scene.lights.clear();
  scene.add_light(LightType::distant).angular_radius = 30;
  const PassMeans with = render_passes(scene, EstimatorType::path, 64);
  scene.scene.surfaces.clear();
  expect_same_mean(with.total[0], render_passes(scene, EstimatorType::path, 64).total[0]);
}

/// A lamp in a closed box of diffuse walls with albedo a and the radiance that its walls have: the
/// light balance. With an integrating sphere of radius R, lit by a small sphere of radius r and
/// radiance L in its centre, the wall receives E = pi L (r / R)^2 / (1 - a (1 - (r / R)^2)), since
/// the lamp, being black, takes its share of what the wall sends out, and sends out a E / pi.
TEST(SurfaceBalance, integrating_sphere) {
  const double lamp = 0.25, albedo = 0.8, share = lamp * lamp;
  MemoryScene scene;
  MaterialSettings wall;
  wall.albedo = Rgb(static_cast<float>(albedo));
  add_surface(scene, SurfaceShape::sphere, scaled(1), wall);
  add_surface(scene, SurfaceShape::sphere, scaled(lamp), shining(1));
  scene.look({0, 0.6, 0}, {0, 0.6, -1}, 30, 6, 6);
  const PassMeans means = render_passes(scene, EstimatorType::path, 400);
  test::expect_mean(means.total[0], albedo * share / (1 - albedo * (1 - share)));
}

class SurfaceLaws : public ::testing::TestWithParam<EstimatorType> {};

/// In a closed room whose walls and fog take nothing in, only the lamp, which is black, ends light.
/// So all the room is as bright as the lamp, by paths and by photons: what it sends out comes back.
TEST_P(SurfaceLaws, white_room_is_as_bright_as_its_lamp) {
  MemoryScene scene;
  scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 0.5;
  scene.scene.render.photons = 8000;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      SurfaceSettings& wall = add_surface(scene, SurfaceShape::quad, scaled(1), white());
      wall.transform = {};
      for (int i = 0; i < 3;
           ++i) // columns: two axes of the wall, and its normal, which points inward
        wall.transform[static_cast<std::size_t>(4 * ((axis + 1 + i) % 3) + i)] = i < 2 ? 1 : -side;
      wall.transform[static_cast<std::size_t>(4 * axis + 3)] = side;
    }
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.5), {0.2, -0.3, -0.1}), shining(1));
  scene.look({-0.7, 0.5, 0.8}, {0.2, 0, 0}, 60, 8, 8);
  const PassMeans means =
      render_passes(scene, GetParam(), GetParam() == EstimatorType::path ? 64 : 24);
  expect_power(means.total[0], 0.01);
  expect_mean(means.total[0], 1, GetParam() == EstimatorType::path ? 0 : 0.01);
}

/// Two equal squares face each other: the form factor (Howell, A catalog of radiation heat transfer
/// configuration factors, C-11) times radiance pi is the mean irradiance.
TEST(SurfaceFormFactor, parallel_squares) {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, moved(scaled(0.5), {0, 0, 1}, true), shining(1));
  add_surface(scene, SurfaceShape::quad, scaled(0.5), white());
  // Straight from above, through the lamp, which the camera does not see.
  scene.scene.surfaces[0].visible = false;
  look_down(scene, 0.5, 16);
  const PassMeans means = render_passes(scene, EstimatorType::path, 64);
  const double x = 1, y = 1; // side over distance
  const double factor = 2 / (M_PI * x * y) *
                        (std::log(std::sqrt((1 + x * x) * (1 + y * y) / (1 + x * x + y * y))) +
                         x * std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)) +
                         y * std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) -
                         x * std::atan(x) - y * std::atan(y));
  EXPECT_NEAR(factor, 0.1998, 1e-4);
  test::expect_mean(means.total[0], factor);
}

/// Two perpendicular squares with a common edge, F = 0.20004 (Howell, C-14).
TEST(SurfaceFormFactor, perpendicular_squares) {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(0.5), white());
  // The lamp stands on the edge x = -0.5 and faces +x.
  SurfaceSettings lamp;
  lamp.shape = SurfaceShape::quad;
  lamp.material = shining(1);
  lamp.transform = {0, 0, 1, -0.5, 0.5, 0, 0, 0, 0, 0.5, 0, 0.5};
  scene.scene.surfaces.push_back(lamp);
  look_down(scene, 0.5, 16);
  test::expect_mean(render_passes(scene, EstimatorType::path, 64).total[0], 0.20004, 1e-5);
}

/// A wall's shadow in a thin homogeneous medium, parallel light from above: single scattering along
/// the camera ray against quadrature.
TEST_P(SurfaceLaws, shadow_of_a_wall_in_a_medium) {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box(Vec3d(-1), Vec3d(1));
  box.extinction = 0.7;
  box.albedo = Rgb(0.5f);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0, -1, 0};
  sun.irradiance = Rgb(3);
  MaterialSettings black;
  black.albedo = Rgb(0);
  // Half of the top is covered, at x < 0; the camera looks along x at half height.
  SurfaceSettings lid;
  lid.shape = SurfaceShape::quad;
  lid.material = black;
  lid.transform = {1, 0, 0, -1, 0, 0, 1, 1.5, 0, 1, 0, 0};
  scene.scene.surfaces.push_back(lid);
  scene.scene.render.max_bounces = 1;
  scene.look({-1000, 0, 0}, {0, 0, 0}, 1e-4, 2, 2);
  double sum = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps; // only x in (0, 1) is lit, 1 below the top
    sum += std::exp(-0.7 * (1 + x)) * std::exp(-0.7) * 0.35 / (4 * M_PI) * 3 / steps;
  }
  const PassMeans means = render_passes(scene, GetParam(), 256);
  test::expect_mean(means.total[0], sum, 1e-4 * sum);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, SurfaceLaws,
                         ::testing::Values(EstimatorType::path, EstimatorType::beam,
                                           EstimatorType::march),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

/// A sky is seen through a sphere of glass where Snell's law has it, and no less bright.
TEST(SurfaceSky, through_clear_glass) {
  MemoryScene scene;
  LightSettings& sky = scene.add_light(LightType::distant);
  sky.direction = {0, 0, 1};
  sky.irradiance = Rgb(1);
  sky.angular_radius = 45;
  add_surface(scene, SurfaceShape::sphere, scaled(1), white_glass());
  scene.look({0, 0, 1000}, {0, 0, 0}, 0.01, 2, 2);
  // Through the middle: two interfaces of T = 0.96, with internal reflections to all
  // orders, comes out to the front or the back: T / (2 - T) to the front.
  const double radiance = 1 / (M_PI * 0.5);
  const PassMeans means = render_passes(scene, EstimatorType::path, 2000);
  test::expect_mean(means.total[0], radiance * 0.96 / 1.04, 1e-3 * radiance);
}

/// In a closed cavity of radiance 1, with emitting walls, a grey medium that glows as the walls do
/// is invisible (Kirchhoff).
TEST(SurfaceKirchhoff, emissive_wall_and_absorbing_medium) {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box(Vec3d(-1), Vec3d(1));
  box.extinction = 1.5;
  box.albedo = Rgb(0.4f);
  scene.glow(test::uniform_field({1, 1, 1}, 1), test::box_map({1, 1, 1}, Vec3d(-1), Vec3d(1)))
      .scale = 1.5 * 0.6;
  SurfaceSettings& wall = add_surface(scene, SurfaceShape::sphere, scaled(2), shining(1));
  wall.material.two_sided = true;
  add_surface(scene, SurfaceShape::sphere, scaled(0.5), white());
  scene.look({0, 0, 1.8}, {0, 0, 0}, 60, 6, 6);
  const PassMeans means = render_passes(scene, EstimatorType::path, 128);
  test::expect_mean(means.total[0], 1);
  expect_every_pixel(means, 1, 0.1);
}

/// A mirror room has no end; paths in it do, and what they bring is right.
TEST(SurfaceRoulette, closed_room_of_mirrors) {
  MemoryScene scene;
  MaterialSettings mirror = of_type(MaterialType::mirror);
  mirror.reflectance = Rgb(0.5f);
  add_surface(scene, SurfaceShape::sphere, scaled(1), mirror);
  scene.add_light(LightType::environment).radiance = Rgb(1);
  scene.look({0.3, 0.1, 0}, {0, 0, -0.2}, 60, 4, 4);
  expect_every_pixel(render_passes(scene, EstimatorType::path, 4), 0, 0);
  scene.scene.surfaces[0].material.reflectance = Rgb(1);
  expect_every_pixel(render_passes(scene, EstimatorType::path, 4), 0, 0);
}

TEST(Surfaces, holdouts_are_black_and_transparent) {
  MemoryScene scene;
  scene.add_box({-1, -1, -3}, {1, 1, 1}).extinction = 0.5;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  add_surface(scene, SurfaceShape::quad, scaled(5), of_type(MaterialType::holdout));
  scene.look({0, 0, 4}, {0, 0, 0}, 5, 4, 4);
  const PassMeans means = render_passes(scene, EstimatorType::path, 4);
  EXPECT_NEAR(means.opacity.mean(), 1 - std::exp(-0.5), 1e-3);
  EXPECT_EQ(means.background[0].mean(), 0);
  scene.scene.surfaces[0].material = white();
  const PassMeans solid = render_passes(scene, EstimatorType::path, 4);
  EXPECT_NEAR(solid.opacity.mean(), 1, 1e-6);
  EXPECT_NEAR(solid.depth.mean(),
              (1 - std::exp(-0.5)) * (3 + 1 / 0.5 - 1 / (std::exp(0.5) - 1)) + std::exp(-0.5) * 4,
              0.02);
}

TEST(Surfaces, no_embree_device_without_any) {
  MemoryScene scene;
  scene.add_box(Vec3d(-1), Vec3d(1));
  const int before = SurfaceSet::devices_made();
  const World world = scene.world();
  EXPECT_EQ(world.surfaces, nullptr);
  EXPECT_EQ(SurfaceSet::devices_made(), before);
  add_surface(scene, SurfaceShape::sphere, scaled(1), white());
  EXPECT_NE(scene.world().surfaces, nullptr);
  EXPECT_EQ(SurfaceSet::devices_made(), before + 1);
}

} // namespace
} // namespace vdbeam
