// Pictures on surfaces: what they reflect and what they send out is what the picture shows.
#include "lights/surface_light.h"
#include "math/sampling.h"
#include "support/surface_test.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using test::TempFolder;
using namespace test::surfaces;

/// A picture of single precision whose texels are `value(x, y)`, rows from the top.
template <class Value>
std::string write_picture(const TempFolder& folder, int width, int height, const Value& value) {
  Image image;
  image.width = width;
  image.height = height;
  for (int c = 0; c < 3; ++c) {
    ImageChannel channel{std::string(1, "RGB"[c]), {}};
    channel.half = false;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        channel.data.push_back(value(x, y)[c]);
    image.channels.push_back(channel);
  }
  const std::string path = folder.file("picture.exr");
  write_exr(image, path);
  return path;
}

/// Dark but for a few colours, which differ by more than 1000.
Rgb lamps(int x, int y) {
  if (x == 1 && y == 2)
    return {10, 5, 1};
  return x == 6 && y == 5 ? Rgb{2, 2, 8} : Rgb(0.002f);
}
constexpr int side = 8;
/// Its mean, which a bilinear picture that ends at its edges keeps.
Rgb mean_of_lamps() {
  Rgb sum;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      sum += lamps(x, y) / static_cast<float>(side * side);
  return sum;
}

MaterialSettings shows(const std::string& picture, MaterialType type) {
  MaterialSettings material = of_type(type);
  material.texture = picture;
  material.texture_wrap = TextureWrap::clamp;
  return material;
}

const SurfaceLight& lamp_of(const World& world) {
  return dynamic_cast<const SurfaceLight&>(world.lights[0]);
}

Samples powers(const Light& light, int channel) {
  Samples samples;
  Rng rng({3, 0, 0}, RngStage::test, 0);
  for (int i = 0; i < 100000; ++i)
    samples.add(static_cast<double>(light.emit((i + 0.5) / 100000, rng).flux[channel]));
  return samples;
}

/// Two triangles whose UV are those of the quad.
std::string write_square(const TempFolder& folder, bool with_uvs) {
  const std::string path = folder.file(with_uvs ? "square.obj" : "plain.obj");
  test::write_bytes(
      path, std::string("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n") +
                (with_uvs ? "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n" : "f 1 2 3 4\n"));
  return path;
}

/// A lamp of an edge of 2 s, as a quad or a mesh.
MemoryScene panel(const std::string& picture, double s, const std::string& mesh = {}) {
  MemoryScene scene;
  SurfaceSettings& quad =
      add_surface(scene, SurfaceShape::quad, scaled(s), shows(picture, MaterialType::emissive));
  if (!mesh.empty()) {
    quad.shape = SurfaceShape::file;
    quad.file = mesh;
  }
  return scene;
}

TEST(TexturedLamp, photons_carry_the_integral) {
  const TempFolder folder;
  const std::string picture = write_picture(folder, side, side, lamps);
  for (const std::string& mesh : {std::string(), write_square(folder, true)}) {
    const World world = panel(picture, 3, mesh).world();
    const SurfaceLight& lamp = lamp_of(world);
    const double area = 36 * world.space.scale * world.space.scale;
    for (int c = 0; c < 3; ++c) {
      const double power = M_PI * area * static_cast<double>(mean_of_lamps()[c]);
      EXPECT_NEAR(static_cast<double>(lamp.power()[c]), power, 2e-3 * power);
      expect_mean(powers(lamp, c), power, 1e-4 * power);
    }
    // Drawn uniformly the red photons' power would stray by 11 times its mean.
    const Samples red = powers(lamp, 0);
    EXPECT_LT(std::sqrt(red.variance()), 1.2 * red.mean());
  }
}

/// Over the sphere by the formula of a lat-long picture.
TEST(TexturedLamp, stretched_sphere_and_both_sides) {
  const TempFolder folder;
  const std::string picture = write_picture(folder, side, side, lamps);
  MemoryScene scene;
  SurfaceSettings& globe =
      add_surface(scene, SurfaceShape::sphere, scaled(0.5), shows(picture, MaterialType::emissive));
  globe.material.two_sided = true;
  std::vector<std::string> notes;
  const Texture texture = read_texture(globe.material, true, notes);
  Vec3d sum{};
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double theta = M_PI * (i + 0.5) / steps;
      const double ring = std::sin(theta) * (M_PI / steps) * (2 * M_PI / steps);
      sum += Vec3d(texture.at(
                 {static_cast<float>((j + 0.5) / steps), static_cast<float>(1 - theta / M_PI)})) *
             ring;
    }
  const World world = scene.world();
  const double factor = 2 * M_PI * 0.25 * world.space.scale * world.space.scale;
  for (int c = 0; c < 3; ++c)
    expect_mean(powers(lamp_of(world), c), sum[c] * factor, 1e-3 * sum[c] * factor);
}

/// Every way to a point of the lamp has the density that the other strategies assume.
TEST(TexturedLamp, densities_are_those_of_the_samples) {
  const TempFolder folder;
  const std::string picture = write_picture(folder, side, side, lamps);
  for (const std::string& mesh : {std::string(), write_square(folder, true)})
    for (const double stretch : {1.0, 0.25}) {
      MemoryScene scene = panel(picture, 1, mesh);
      scene.scene.surfaces[0].transform[0] = stretch;
      const World world = scene.world();
      const SurfaceLight& lamp = lamp_of(world);
      const Vec3f point{0.1f, -0.2f, 0.3f};
      Rng rng({}, RngStage::test, 1);
      Samples arriving, all_around;
      for (int i = 0; i < 40000; ++i) {
        const float u = rng.uniform(), v = rng.uniform();
        const IncidentSample sample = lamp.sample_incident(point, u, v);
        arriving.add(static_cast<double>(sample.value.x));
        const auto hit = world.surfaces->set->intersect({{point, sample.wi}});
        ASSERT_TRUE(hit);
        // Where two cells meet a rounding chooses.
        if (i % 10 == 0 && std::abs(lamp.surface_pdf(*hit, sample.wi) / sample.pdf - 1) > 1e-3f) {
          const Vec3f aside = normalize(sample.wi + Vec3f(2e-5f, 1e-5f, 0));
          const auto beside = world.surfaces->set->intersect({{point, aside}});
          EXPECT_NEAR(lamp.surface_pdf(*beside, aside), sample.pdf, 1e-2f * sample.pdf);
        }
        const float a = rng.uniform(), b = rng.uniform();
        const Vec3f direction = direction_about({0, 0, -1}, a, 2 * pi * b);
        all_around.add(2 * M_PI *
                       static_cast<double>(lamp.emitted_radiance({{point, direction}}).radiance.x));
      }
      test::expect_same_mean(arriving, all_around);
      EXPECT_LT(arriving.error(), 0.02 * arriving.mean());
    }
}

/// A white sky on a picture that reflects: every pixel is its texel.
TEST(TexturedDiffuse, shows_the_picture_upright) {
  const TempFolder folder;
  const auto shades = [](int x, int y) {
    return Rgb{static_cast<float>(x) / side, static_cast<float>(y) / side, 0.5f};
  };
  const std::string picture = write_picture(folder, side, side, shades);
  for (const std::string& mesh : {std::string(), write_square(folder, true)}) {
    MemoryScene scene = panel(picture, 1, mesh);
    scene.scene.surfaces[0].material = shows(picture, MaterialType::diffuse);
    scene.add_light(LightType::environment).radiance = Rgb(1);
    look_down(scene, 1.0, side);
    for (const EstimatorType estimator : {EstimatorType::path, EstimatorType::beam}) {
      const PassMeans means = render_passes(scene, estimator, 200);
      for (int y = 1; y + 1 < side; ++y)
        for (int x = 1; x + 1 < side; ++x)
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(means.pixels[static_cast<std::size_t>(y * side + x)][c], shades(x, y)[c],
                        0.015)
                << x << " " << y << " " << c;
    }
  }
}

TEST(TexturedDiffuse, albedo_is_a_factor) {
  const TempFolder folder;
  MemoryScene scene = panel(write_picture(folder, 1, 1, [](int, int) { return Rgb(0.5f); }), 1);
  scene.scene.surfaces[0].material.type = MaterialType::diffuse;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  scene.look({0, 0, 2}, {0, 0, 0}, 30, 2, 2);
  expect_mean(render_passes(scene, EstimatorType::path, 4).total[0], 0.5);
  scene.scene.surfaces[0].material.albedo = Rgb(0.4f);
  expect_mean(render_passes(scene, EstimatorType::path, 4).total[0], 0.2);
}

/// A picture shines into fog, above a floor: with photons as with paths.
TEST(TexturedLamp, beam_agrees_with_path_in_fog) {
  const TempFolder folder;
  MemoryScene scene = panel(write_picture(folder, side, side, lamps), 0.8);
  scene.scene.surfaces[0].transform = moved(scaled(0.8), {0, 0, -1.1});
  scene.scene.surfaces[0].visible = false; // it would outshine the fog
  VolumeSettings& box = scene.add_box(Vec3d(-1), Vec3d(1));
  box.extinction = 1;
  box.albedo = Rgb(0.9f);
  MaterialSettings floor;
  floor.albedo = Rgb(0.5f);
  add_surface(scene, SurfaceShape::quad, {1.5, 0, 0, 0, 0, 0, 1.5, -1.1, 0, -1.5, 0, 0}, floor);
  scene.scene.render.photons = 10000;
  scene.look({0.5, 0.8, 4}, {0, -0.2, 0}, 34, 8, 8);
  expect_beam_agrees_with_path(scene);
}

TEST(Textures, meshes_without_uvs_are_one_clear_error) {
  const TempFolder folder;
  const std::string picture = write_picture(folder, side, side, lamps);
  const MemoryScene scene = panel(picture, 1, write_square(folder, false));
  try {
    scene.world();
    ADD_FAILURE() << "no complaint";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(
        text.find("plain.obj: has no texture coordinates (UV), which mesh.0.material.texture"),
        std::string::npos)
        << text;
  }
}

} // namespace
} // namespace vdbeam
