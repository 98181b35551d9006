// What images add to surfaces: holes, roughness and metal from point to point, and normals.
#include "math/rng.h"
#include "support/surface_test.h"
#include "support/temp_folder.h"
#include "vdbeam/image_file.h"

#include <gtest/gtest.h>

#include <functional>

namespace vdbeam {
namespace {

using test::TempFolder;
using namespace test::surfaces;

/// A square picture of single precision whose texels are `value(x, y)`, rows from the top.
std::string write_square(const TempFolder& folder, int side,
                         const std::function<Rgb(int, int)>& value) {
  Image image;
  image.width = image.height = side;
  for (int c = 0; c < 3; ++c) {
    ImageChannel channel{std::string(1, "RGB"[c]), {}};
    channel.half = false;
    for (int i = 0; i < side * side; ++i)
      channel.data.push_back(value(i % side, i / side)[c]);
    image.channels.push_back(channel);
  }
  static int count = 0;
  const std::string path = folder.file(std::to_string(count++) + ".exr");
  write_exr(image, path);
  return path;
}
std::string write_constant(const TempFolder& folder, const Rgb& value) {
  return write_square(folder, 1, [&](int, int) { return value; });
}

MaterialSettings half_open(double albedo, double opacity) {
  MaterialSettings material = diffuse(albedo);
  material.opacity = opacity;
  return material;
}

constexpr EstimatorType estimators[] = {EstimatorType::path, EstimatorType::beam};

/// A ray through a disk meets it once, one through a ball twice.
TEST(Opacity, stops_its_share_of_camera_rays) {
  for (const bool ball : {false, true})
    for (const EstimatorType estimator : estimators) {
      MemoryScene scene;
      add_surface(scene, ball ? SurfaceShape::sphere : SurfaceShape::disk, scaled(1),
                  half_open(0, 0.3));
      scene.add_light(LightType::environment).radiance = Rgb(1);
      scene.look({0, 0, 9}, {0, 0, 0}, 6, 8, 8);
      const PassMeans means = render_passes(scene, estimator, 200);
      test::expect_mean(means.total[0], ball ? 0.49 : 0.7);
      EXPECT_LT(means.total[0].error(), 0.01);
    }
}

TEST(Opacity, white_surfaces_with_holes_vanish_in_an_even_sky) {
  for (const EstimatorType estimator : estimators) {
    MemoryScene scene;
    add_surface(scene, SurfaceShape::sphere, scaled(0.5), half_open(1, 0.5));
    scene.add_light(LightType::environment).radiance = Rgb(1);
    scene.look({0, 0.3, 4}, {0, 0, 0}, 18, 8, 8);
    const PassMeans means = render_passes(scene, estimator, 64);
    test::expect_mean(means.total[0], 1, estimator == EstimatorType::path ? 1e-4 : 0.01);
  }
}

/// Sunlight on a floor under a black screen that the camera does not see.
TEST(Opacity, shadows_have_its_share) {
  for (const EstimatorType estimator : estimators) {
    MemoryScene scene;
    add_surface(scene, SurfaceShape::quad, moved(scaled(4), {0, 0, 1}), half_open(0, 0.25))
        .visible = false;
    add_surface(scene, SurfaceShape::quad, scaled(2), diffuse(0.5));
    LightSettings& sun = scene.add_light(LightType::distant);
    sun.direction = {0, 0, -1};
    sun.irradiance = Rgb(1);
    look_down(scene, 1.0, 8);
    const PassMeans means = render_passes(scene, estimator, 100);
    test::expect_mean(means.total[0], 0.75 * 0.5 / M_PI, 1e-4);
    EXPECT_LT(means.total[0].error(), 2e-3);
  }
}

/// Fog under a screen with holes, lit by photons alone, by shadow rays, and by paths.
TEST(Opacity, photons_and_paths_agree_in_fog) {
  const TempFolder folder;
  MemoryScene scene;
  MaterialSettings screen = diffuse(0.5);
  screen.opacity_texture =
      write_square(folder, 4, [](int x, int y) { return Rgb((x + y) % 2 ? 0.9f : 0.2f); });
  add_surface(scene, SurfaceShape::quad, {1.2, 0, 0, 0, 0, 0, 1.2, 1.1, 0, -1.2, 0, 0}, screen);
  add_surface(scene, SurfaceShape::quad, {1.5, 0, 0, 0, 0, 0, 1.5, -1.1, 0, -1.5, 0, 0},
              diffuse(0.5));
  VolumeSettings& box = scene.add_box(Vec3d(-1), Vec3d(1));
  box.extinction = 1;
  box.albedo = Rgb(0.9f);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0.2, -1, 0.1};
  sun.angular_radius = 2;
  scene.scene.render.photons = 10000;
  scene.look({0.5, 0.8, 4}, {0, 0, 0}, 34, 8, 8);
  expect_beam_agrees_with_path(scene);
}

/// Whole texels are there or not: no pixel is in between.
TEST(Opacity, cutoff_makes_holes) {
  constexpr int side = 8;
  const TempFolder folder;
  const auto opacity = [](int x, int y) { return Rgb((3 * x + 5 * y) % 4 < 2 ? 0.1f : 0.9f); };
  MemoryScene scene;
  MaterialSettings leaf = half_open(0, 1);
  leaf.opacity_texture = write_square(folder, side, opacity);
  leaf.opacity_cutoff = 0.5;
  leaf.texture_wrap = TextureWrap::clamp;
  add_surface(scene, SurfaceShape::quad, scaled(1), leaf);
  scene.add_light(LightType::environment).radiance = Rgb(1);
  look_down(scene, 1.0, 4 * side);
  const PassMeans means = render_passes(scene, EstimatorType::path, 4);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) // one of the pixels at the middle of the texel
      EXPECT_EQ(means.pixels[static_cast<std::size_t>((4 * y + 1) * 4 * side + 4 * x + 1)].x,
                opacity(x, y).x < 0.5f ? 1 : 0)
          << x << " " << y;
}

/// A glossy floor that reflects a lamp, by one number and by an image of another factor.
TEST(MaterialMaps, constant_images_are_numbers) {
  const TempFolder folder;
  const auto render = [&](const MaterialSettings& floor, const EstimatorType& estimator) {
    MemoryScene scene;
    add_surface(scene, SurfaceShape::quad, scaled(2), floor);
    add_surface(scene, SurfaceShape::sphere, moved(scaled(0.5), {1.5, 0, 1}), shining(4));
    scene.look({-3, 0, 1.5}, {0, 0, 0}, 20, 8, 8);
    return render_passes(scene, estimator, 100);
  };
  MaterialSettings number = of_type(MaterialType::standard);
  number.albedo = Rgb(0.4f);
  number.metal = 0.3;
  number.roughness = 0.45; // between two of the steps in which images are taken
  MaterialSettings image = number;
  image.metal = 0.6;
  image.roughness = 0.9;
  image.roughness_texture = image.metal_texture = write_constant(folder, {0, 0.5f, 0.5f});
  for (const EstimatorType estimator : estimators) {
    const PassMeans expected = render(number, estimator), found = render(image, estimator);
    EXPECT_EQ(regions_apart(found, expected, 0.02), 0)
        << found.total[0].mean() << " against " << expected.total[0].mean();
    test::expect_power(found.total[0], 0.03 * found.total[0].mean());
  }
}

/// The code of a normal that leans by an angle towards an angle about the z axis.
Rgb leaning(double by, double towards) {
  const double x = std::sin(by) * std::cos(towards), y = std::sin(by) * std::sin(towards);
  return Rgb(Vec3d{x + 1, y + 1, std::cos(by) + 1} * 0.5);
}

/// A surface that leans towards the sun, or aside, has the cosine of that.
TEST(NormalMap, leans_along_u_and_v) {
  const TempFolder folder;
  const double sun_angle = 40 * M_PI / 180, by = 30 * M_PI / 180;
  const Vec3d to_sun{std::sin(sun_angle), 0, std::cos(sun_angle)};
  // As a quad, and as a mesh whose picture lies on its side: u grows along y, v against x.
  const std::string mesh = folder.file("square.obj");
  test::write_bytes(mesh, "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
                          "f 1/1 2/2 3/3 4/4\n");
  for (const bool turned : {false, true})
    for (const double towards : {0.0, 0.5 * M_PI, M_PI}) {
      MemoryScene scene;
      MaterialSettings material = diffuse(1);
      material.normal_texture = write_constant(folder, leaning(by, towards));
      SurfaceSettings& floor = add_surface(scene, SurfaceShape::quad, scaled(1), material);
      if (turned) {
        floor.shape = SurfaceShape::file;
        floor.file = mesh;
      }
      LightSettings& sun = scene.add_light(LightType::distant);
      sun.direction = to_sun * -1.0;
      sun.irradiance = Rgb(static_cast<float>(M_PI));
      look_down(scene, 0.5, 4);
      const double turn = towards + (turned ? M_PI / 2 : 0);
      const Vec3d normal{std::sin(by) * std::cos(turn), std::sin(by) * std::sin(turn),
                         std::cos(by)};
      for (const EstimatorType estimator : estimators)
        for (const Rgb& pixel : render_passes(scene, estimator, 4).pixels)
          EXPECT_NEAR(pixel.x, std::max(0.0, dot(normal, to_sun)), 2e-3) << turned << towards;
    }
}

TEST(NormalMap, even_sky_lights_all_slopes_alike) {
  const TempFolder folder;
  for (const MaterialSettings& kind : {diffuse(1), of_type(MaterialType::dielectric)}) {
    MaterialSettings material = kind;
    material.normal_texture =
        write_square(folder, 8, [](int x, int y) { return leaning(0.1 * (x % 5), 0.7 * y); });
    MemoryScene scene;
    add_surface(scene, SurfaceShape::sphere, scaled(0.5), material);
    scene.add_light(LightType::environment).radiance = Rgb(1);
    scene.look({0, 0.3, 4}, {0, 0, 0}, 18, 16, 16);
    for (const EstimatorType estimator : estimators) {
      // A few paths are caught in the glass until roulette ends them.
      const PassMeans means = render_passes(scene, estimator, 64);
      test::expect_mean(means.total[0], 1, 1e-3);
      EXPECT_LT(means.total[0].error(), 2e-3) << material.type.name;
    }
  }
}

/// A step to the right changes u alone, one up v alone, wherever the picture lies on a shape.
TEST(NormalMap, directions_are_those_of_the_picture) {
  Rng rng({}, RngStage::test, 0);
  for (const SurfaceShape kind : {SurfaceShape::sphere, SurfaceShape::quad, SurfaceShape::disk,
                                  SurfaceShape::plane, SurfaceShape::box, SurfaceShape::cylinder}) {
    const auto shape = make_simple_shape(kind);
    for (int i = 0; i < 200; ++i) {
      const double part = (i + 0.5) / 200, u = rng.uniform(), v = rng.uniform();
      const std::size_t primitive = static_cast<std::size_t>(
          part * static_cast<double>(kind == SurfaceShape::plane ? 1 : shape->primitives()));
      const ShapePoint point = shape->sample(primitive, AreaPlace{u, v});
      const UvDirections found = shape->uv_directions(primitive, point.position, point.normal);
      const auto change = [&](const Vec3d& direction) {
        constexpr double step = 2e-3;
        const Vec3d half = normalize(direction) * (step / 2);
        const Uv a = shape->uv(primitive, point.position - half),
                 b = shape->uv(primitive, point.position + half);
        const auto wrapped = [](float x) {
          return (static_cast<double>(x) - std::round(static_cast<double>(x))) / step;
        };
        return std::pair{wrapped(b.u - a.u), wrapped(b.v - a.v)};
      };
      const auto [right_u, right_v] = change(found.right);
      const auto [up_u, up_v] = change(found.up);
      EXPECT_GT(right_u, 0);
      EXPECT_NEAR(right_v, 0, 0.01 * right_u) << static_cast<int>(kind);
      EXPECT_GT(up_v, 0);
      EXPECT_NEAR(up_u, 0, 0.02 * up_v) << static_cast<int>(kind);
    }
  }
}

} // namespace
} // namespace vdbeam
