// Light that mirrors and glass send on to other surfaces, which shadow rays do not find.
#include "support/surface_test.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

constexpr double albedo = 0.6, intensity = 4;

/// A floor at z = 0; the camera sees the middle, from -0.15 to 0.15.
MemoryScene floor_from_above() {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(albedo));
  scene.scene.render.photons = 20000;
  look_down(scene, 0.15, 16);
  return scene;
}

void add_point_light(MemoryScene& scene, const Vec3d& position) {
  LightSettings& light = scene.add_light(LightType::point);
  light.position = position;
  light.intensity = Rgb(static_cast<float>(intensity));
}

/// The mean radiance of what the camera sees of the floor, lit by a point light, by quadrature.
double lit_floor(const Vec3d& light) {
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const Vec3d to =
          light - Vec3d{0.3 * ((i + 0.5) / steps - 0.5), 0.3 * ((j + 0.5) / steps - 0.5), 0};
      sum += light.z / std::pow(dot(to, to), 1.5);
    }
  return albedo / M_PI * intensity * sum / (steps * steps);
}

class Caustics : public ::testing::TestWithParam<EstimatorType> {};

/// Glass of index 1 stops shadow rays but bends no light: photons bring all of it.
TEST_P(Caustics, glass_of_index_1_casts_no_shadow) {
  MemoryScene scene = floor_from_above();
  MaterialSettings glass = of_type(MaterialType::dielectric);
  glass.ior = 1;
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.3), {0, 0, 0.5}), glass).visible = false;
  add_point_light(scene, {0, 0, 1.5});
  const double expected = lit_floor({0, 0, 1.5});
  const PassMeans means = render_passes(scene, GetParam(), 32);
  expect_power(means.total[0], 0.01 * expected);
  expect_mean(means.total[0], expected, 0.01 * expected);
}

/// The same by way of fog, with light that the fog scatters before and after the glass: as without.
TEST_P(Caustics, in_fog) {
  const auto floor = [&](bool glass) {
    MemoryScene scene = floor_from_above();
    scene.add_box({-1, -1, 0}, {1, 1, 1.2}).extinction = 0.7;
    MaterialSettings material = of_type(MaterialType::dielectric);
    material.ior = 1;
    if (glass)
      add_surface(scene, SurfaceShape::sphere, moved(scaled(0.3), {0, 0, 0.5}), material).visible =
          false;
    add_point_light(scene, {0, 0, 1.5});
    return render_passes(scene, GetParam(), 32).background[0];
  };
  const test::Samples clear = floor(false);
  const test::Samples with_glass = floor(true);
  expect_power(with_glass, 0.01 * clear.mean());
  test::expect_same_mean(with_glass, clear, 0.015 * clear.mean());
}

/// A mirror beside a floor: the light that shines on the floor once more, from its image.
TEST_P(Caustics, a_mirror_doubles_a_lamp) {
  MemoryScene scene = floor_from_above();
  SurfaceSettings& mirror =
      add_surface(scene, SurfaceShape::quad, scaled(1), of_type(MaterialType::mirror));
  mirror.transform = {0, 0, 1, -0.5, 1, 0, 0, 0, 0, 1, 0, 1.001};
  add_point_light(scene, {0.3, 0, 1});
  const double expected = lit_floor({0.3, 0, 1}) + lit_floor({-1.3, 0, 1});
  const PassMeans means = render_passes(scene, GetParam(), 32);
  expect_mean(means.total[0], expected, 0.01 * expected);
}

/// The same with rough metal, in which path tracing finds the lamp: region by region the same.
TEST_P(Caustics, rough_metal_beside_a_floor) {
  MemoryScene scene = floor_from_above();
  MaterialSettings metal = of_type(MaterialType::conductor);
  metal.roughness = 0.5;
  SurfaceSettings& wall = add_surface(scene, SurfaceShape::quad, scaled(1), metal);
  wall.transform = {0, 0, 1, -0.5, 1, 0, 0, 0, 0, 1, 0, 1.001};
  add_point_light(scene, {0.3, 0, 1});
  const PassMeans path = render_passes(scene, EstimatorType::path, 256);
  const PassMeans mine = render_passes(scene, GetParam(), 32);
  EXPECT_GT(path.total[0].mean(), 1.02 * lit_floor({0.3, 0, 1})) << "nothing comes from the metal";
  EXPECT_EQ(test::regions_apart(mine, path, 0.01), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
}

/// By how much the pixels' values differ from pass to pass, relative to the mean of the picture.
double spread(const PassMeans& means, int passes) {
  double square = 0;
  for (const test::Samples& pixel : means.brightness)
    square += pixel.error() * pixel.error() * passes;
  return std::sqrt(square / static_cast<double>(means.brightness.size())) / means.total[0].mean();
}

/// Paths that find the sun in a ball of metal by chance are bright; photons have no such pixels.
TEST_P(Caustics, a_ball_of_metal_in_the_sun_makes_no_fireflies) {
  MemoryScene scene = floor_from_above();
  scene.look({0, -1.5, 1.2}, {0, 0, 0}, 40, 16, 16);
  MaterialSettings metal = of_type(MaterialType::conductor);
  metal.roughness = 0.25;
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.3), {0, 0, 0.32}), metal).visible = false;
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {-0.4, 0.3, -0.85};
  sun.angular_radius = 0.27;
  const PassMeans mine = render_passes(scene, GetParam(), 32);
  const PassMeans path = render_passes(scene, EstimatorType::path, 512);
  EXPECT_LT(spread(mine, 32), 0.2 * spread(path, 512));
  EXPECT_EQ(test::regions_apart(mine, path, 0.02), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
}

/// A lamp so wide that path tracing meets it through a ball of glass: region by region the same.
TEST_P(Caustics, under_a_ball_of_glass) {
  MemoryScene scene = floor_from_above();
  scene.look({0, 1.2, 1.2}, {0, 0, 0}, 40, 16, 16);
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.3), {0, 0, 0.5}),
              of_type(MaterialType::dielectric));
  add_surface(scene, SurfaceShape::disk, moved(scaled(0.3), {0, 0, 1.5}, true), shining(10));
  scene.scene.render.photons = 40000;
  const PassMeans path = render_passes(scene, EstimatorType::path, 256);
  const PassMeans mine = render_passes(scene, GetParam(), 48);
  EXPECT_EQ(test::regions_apart(mine, path, 0.02), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
}

/// A square, seen whole, in a ball of glass of index 1, through which a distant light shines on it:
/// all of that comes by photons.
MemoryScene square_by_photons(const Vec3d& direction) {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(albedo));
  MaterialSettings glass = of_type(MaterialType::dielectric);
  glass.ior = 1;
  add_surface(scene, SurfaceShape::sphere, scaled(3), glass).visible = false;
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = direction;
  sun.irradiance = Rgb(1);
  scene.scene.render.photons = 20000;
  look_down(scene, 1.0, 16);
  return scene;
}

TEST_P(Caustics, even_light_is_even_up_to_edges_and_corners) {
  const double expected = albedo / M_PI;
  const PassMeans means = render_passes(square_by_photons({0, 0, -1}), GetParam(), 32);
  const auto pixel = [&](int x, int y) {
    return means.brightness[static_cast<std::size_t>(y * 16 + x)];
  };
  test::Samples corners, edges;
  for (const int i : {0, 15})
    for (int k = 0; k < 16; ++k) {
      (k == 0 || k == 15 ? corners : edges).add(pixel(i, k).mean());
      if (k > 0 && k < 15)
        edges.add(pixel(k, i).mean());
    }
  EXPECT_NEAR(corners.mean(), expected, 0.1 * expected) << "+- " << corners.error();
  EXPECT_NEAR(edges.mean(), expected, 0.03 * expected) << "+- " << edges.error();
  expect_mean(means.total[0], expected, 0.02 * expected);
}

/// A sheet stands in the middle, and the light comes aslant: one side of it lies in its shadow, the
/// other in the light, up to the sheet.
TEST_P(Caustics, a_sheet_keeps_its_shadow) {
  MemoryScene scene = square_by_photons(normalize(Vec3d{-1, 0, -1}));
  MaterialSettings black;
  black.albedo = Rgb(0);
  SurfaceSettings& sheet = add_surface(scene, SurfaceShape::quad, scaled(1), black);
  sheet.transform = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 1}; // 2 high, across x
  const double expected = albedo / M_PI / std::sqrt(2);
  const PassMeans means = render_passes(scene, GetParam(), 32);
  test::Samples dark, lit;
  for (int y = 2; y < 14; ++y) {
    dark.add(means.brightness[static_cast<std::size_t>(y * 16 + 7)].mean());
    lit.add(means.brightness[static_cast<std::size_t>(y * 16 + 8)].mean());
  }
  EXPECT_NEAR(lit.mean(), expected, 0.06 * expected) << "+- " << lit.error();
  EXPECT_LT(dark.mean(), 0.01 * expected);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Caustics,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

} // namespace
} // namespace vdbeam
