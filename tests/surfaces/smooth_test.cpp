// Meshes that are shaded as the curved surfaces that they stand for.
#include "math/rng.h"
#include "math/sampling.h"
#include "support/surface_test.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

namespace vdbeam {
namespace {

using test::TempFolder;
using namespace test::surfaces;

/// What normal a file gives for a point of a ball, as its number and place.
using NormalOf = std::function<Vec3d(int, const Vec3d&)>;

/// A ball of radius 1 by `rings` rings of twice that number of quadrilaterals, which are triangles
/// at the poles. `normal_of` empty: without normals.
std::string write_ball(const TempFolder& folder, int rings, const NormalOf& normal_of = {}) {
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      const double theta = M_PI * i / rings, phi = M_PI * j / rings;
      const double r = i == 0 || i == rings ? 0 : std::sin(theta);
      const Vec3d p{r * std::cos(phi), r * std::sin(phi), std::cos(theta)};
      text << "v " << p.x << " " << p.y << " " << p.z << "\n";
      if (!normal_of)
        continue;
      const Vec3d n = normal_of(i * 2 * rings + j, p);
      text << "vn " << n.x << " " << n.y << " " << n.z << "\n";
    }
  const auto vertex = [&](int i, int j) {
    const std::string number = std::to_string(i * 2 * rings + j % (2 * rings) + 1);
    return normal_of ? number + "//" + number : number;
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j)
      text << "f " << vertex(i, j) << " " << vertex(i + 1, j) << " " << vertex(i + 1, j + 1) << " "
           << vertex(i, j + 1) << "\n";
  const std::string path = folder.file("ball.obj");
  test::write_bytes(path, text.str());
  return path;
}

SurfaceSettings& add_mesh(MemoryScene& scene, const std::string& file, double smooth_angle,
                          const Transform& at, const MaterialSettings& material) {
  SurfaceSettings& mesh = add_surface(scene, SurfaceShape::file, at, material);
  mesh.file = file;
  mesh.smooth_angle = smooth_angle;
  return mesh;
}

/// A ball in an even sky, whatever it is made of, is not seen.
void expect_furnace(const std::string& ball) {
  for (const MaterialSettings& material :
       {white(), of_type(MaterialType::mirror), of_type(MaterialType::dielectric)}) {
    MemoryScene scene;
    add_mesh(scene, ball, 90, scaled(0.5), material);
    scene.add_light(LightType::environment).radiance = Rgb(1);
    scene.look({0, 0.3, 4}, {0, 0, 0}, 18, 16, 16);
    for (const EstimatorType estimator : {EstimatorType::path, EstimatorType::beam}) {
      const PassMeans means = render_passes(scene, estimator, 4);
      for (const Rgb& pixel : means.pixels)
        EXPECT_NEAR(pixel.x, 1, 2e-3) << material.type.name;
    }
  }
}

/// Nothing is lost or won where the two normals of a coarse ball differ, not even at the horizon.
TEST(SmoothMeshes, furnace) {
  const TempFolder folder;
  expect_furnace(write_ball(folder, 5));
}

/// Any unit vector, the same for a number at all times.
Vec3d random_normal(int number, const Vec3d&) {
  Rng rng({}, RngStage::test, static_cast<std::uint64_t>(number));
  const float u = rng.uniform(), v = rng.uniform();
  return Vec3d(sample_sphere(u, v));
}

/// Normals of the file that have nothing to do with its triangles: the same law.
TEST(SmoothMeshes, furnace_with_senseless_normals) {
  const TempFolder folder;
  expect_furnace(write_ball(folder, 5, random_normal));
}

/// Photons that a curved ball of white or glass sends through fog: the same law.
TEST(SmoothMeshes, furnace_of_photons) {
  const TempFolder folder;
  const std::string ball = write_ball(folder, 6);
  for (const MaterialSettings& material : {white(), of_type(MaterialType::dielectric)}) {
    MemoryScene scene;
    scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 2;
    add_mesh(scene, ball, 90, scaled(0.5), material);
    scene.add_light(LightType::environment).radiance = Rgb(1);
    scene.scene.render.photons = 20000;
    scene.look({0, 0.3, 4}, {0, 0, 0}, 34, 16, 16);
    expect_mean(render_passes(scene, EstimatorType::beam, 24).total[0], 1, 0.01);
  }
}

/// By how much a picture differs from another, relative to the mean.
double difference(const PassMeans& a, const PassMeans& b) {
  double sum = 0, mean = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    sum += std::abs(static_cast<double>(mean_component(a.pixels[i] - b.pixels[i])));
    mean += static_cast<double>(mean_component(b.pixels[i]));
  }
  return sum / mean;
}

/// A coarse ball of mirror or glass shows the sky much as a true ball does, and flat triangles do
/// not.
TEST(SmoothMeshes, show_the_sky_like_a_ball) {
  const TempFolder folder;
  const std::string ball = write_ball(folder, 12);
  for (const MaterialType type : {MaterialType::mirror, MaterialType::dielectric}) {
    const auto picture = [&](double smooth_angle) {
      MemoryScene scene;
      if (smooth_angle < 0)
        add_surface(scene, SurfaceShape::sphere, scaled(1), of_type(type));
      else
        add_mesh(scene, ball, smooth_angle, scaled(1), of_type(type));
      LightSettings& sky = scene.add_light(LightType::sky);
      sky.zenith = Rgb(0.2f);
      sky.ground = Rgb(3);
      scene.look({0, 0, 10}, {0, 0, 0}, 8, 32, 32);
      return render_passes(scene, EstimatorType::beam, 64);
    };
    const PassMeans truth = picture(-1);
    const double smooth = difference(picture(60), truth), flat = difference(picture(0), truth);
    EXPECT_LT(smooth, 0.04) << type.name;
    EXPECT_LT(smooth, 0.5 * flat) << type.name;
  }
}

/// The file's own normals come before those of an angle, and are left aside where that is asked
/// for.
TEST(SmoothMeshes, by_the_normals_of_their_file) {
  const TempFolder folder;
  const auto picture = [&](const std::string& file, bool file_normals, double smooth_angle) {
    MemoryScene scene;
    add_mesh(scene, file, smooth_angle, scaled(1), of_type(MaterialType::mirror)).file_normals =
        file_normals;
    LightSettings& sky = scene.add_light(LightType::sky);
    sky.zenith = Rgb(0.2f);
    sky.ground = Rgb(3);
    scene.look({0, 0, 10}, {0, 0, 0}, 8, 32, 32);
    return render_passes(scene, EstimatorType::beam, 8).pixels;
  };
  const std::string plain = write_ball(folder, 12);
  const auto flat = picture(plain, true, 0), smooth = picture(plain, true, 60);
  const auto outwards = [](int, const Vec3d& p) { return p; };
  const std::string own = write_ball(folder, 12, outwards);
  const auto by_file = picture(own, true, 0);
  EXPECT_NE(by_file, flat);
  EXPECT_EQ(picture(own, true, 1), by_file);
  EXPECT_EQ(picture(own, false, 0), flat);
  EXPECT_EQ(picture(own, false, 60), smooth);
}

/// No light comes into a box.
void expect_darkness_in(const std::string& box, double smooth_angle) {
  MemoryScene scene;
  add_mesh(scene, box, smooth_angle, scaled(1), {});
  scene.add_box(Vec3d(-0.9), Vec3d(0.9)).extinction = 0.5;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {-0.5, -0.6, -0.62};
  sun.irradiance = Rgb(1000);
  scene.look({-0.8, -0.8, -0.7}, {0, 0, 0}, 90, 8, 8);
  for (const EstimatorType estimator : {EstimatorType::path, EstimatorType::beam})
    EXPECT_EQ(render_passes(scene, estimator, 8).total[0].mean(), 0) << estimator.name;
}

const char* const corners_of_a_box = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                                     "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";

/// Corners that are shaded as round: no light comes in, however the normals point.
TEST(SmoothMeshes, no_light_leaks_into_a_box) {
  const TempFolder folder;
  const std::string path = folder.file("box.obj");
  test::write_bytes(path, std::string(corners_of_a_box) +
                              "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  expect_darkness_in(path, 180);
}

/// The same with normals of the file that point anywhere.
TEST(SmoothMeshes, no_light_leaks_by_senseless_normals) {
  const TempFolder folder;
  const std::string path = folder.file("box.obj");
  std::ostringstream text;
  text << corners_of_a_box;
  for (int i = 0; i < 8; ++i) {
    const Vec3d n = random_normal(i, {});
    text << "vn " << n.x << " " << n.y << " " << n.z << "\n";
  }
  test::write_bytes(path, text.str() + "f 4//4 3//3 2//2 1//1\nf 5//5 6//6 7//7 8//8\n"
                                       "f 1//1 2//2 6//6 5//5\nf 2//2 3//3 7//7 6//6\n"
                                       "f 3//3 4//4 8//8 7//7\nf 4//4 1//1 5//5 8//8\n");
  expect_darkness_in(path, 0);
}

/// Sunlight through a lens of triangles onto a floor: photons as path tracing has it.
TEST(SmoothMeshes, focus_light_with_every_estimator) {
  const TempFolder folder;
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(2), white()).material.albedo = Rgb(0.6f);
  add_mesh(scene, write_ball(folder, 10), 60, moved(scaled(0.4), {0, 0, 0.7}),
           of_type(MaterialType::dielectric))
      .visible = false;
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0, 0, -1};
  sun.angular_radius = 10;
  scene.scene.render.photons = 20000;
  look_down(scene, 0.4, 16);
  const PassMeans path = render_passes(scene, EstimatorType::path, 256);
  for (const EstimatorType estimator : {EstimatorType::beam, EstimatorType::march})
    EXPECT_EQ(test::regions_apart(render_passes(scene, estimator, 32), path, 0.03), 0)
        << estimator.name;
}

/// A column of radius 0.5 along z, of eight faces whose normals begin at this angle [degrees].
std::string write_column(const TempFolder& folder, double first) {
  std::ostringstream text;
  for (int i = 0; i < 8; ++i)
    for (const double z : {-1.0, 1.0}) {
      const double phi = (first - 22.5 + 45 * i) * M_PI / 180;
      text << "v " << 0.5 * std::cos(phi) << " " << 0.5 * std::sin(phi) << " " << z << "\n";
    }
  for (int i = 0; i < 8; ++i) {
    const int low = 2 * i + 1, next = 2 * ((i + 1) % 8) + 1;
    text << "f " << low << " " << next << " " << next + 1 << " " << low + 1 << "\n";
  }
  const std::string path = folder.file("column.obj");
  test::write_bytes(path, text.str());
  return path;
}

/// Sunlight through a pane of index 1, which bends none, meets one face of a column at an angle of
/// 1 degree. Photons bring it all. The image is as without the pane, nowhere much brighter.
TEST(SmoothMeshes, ShowNoSpecksWhereLightGrazesAFace) {
  const TempFolder folder;
  MemoryScene scene;
  add_mesh(scene, write_column(folder, 89), 60, scaled(1), diffuse(0.5));
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {-1, 0, 0};
  sun.irradiance = Rgb(static_cast<float>(M_PI));
  scene.scene.render.photons = 20000;
  scene.look({0, 4, 0}, {0, 0, 0}, 16, 24, 24);
  const PassMeans open = render_passes(scene, EstimatorType::beam, 4);
  MaterialSettings pane = glass();
  pane.ior = 1;
  add_surface(scene, SurfaceShape::quad, {0, 0, 1.5, 1, 0, 1.5, 0, 0, -1.5, 0, 0, 0}, pane);
  const PassMeans behind = render_passes(scene, EstimatorType::beam, 32);
  const auto brightest = [](const PassMeans& means) {
    float most = 0;
    for (const Rgb& pixel : means.pixels)
      most = std::max(most, pixel.x);
    return most;
  };
  expect_same_mean(behind.total[0], open.total[0], 0.03 * open.total[0].mean());
  EXPECT_LT(brightest(behind), 1.2f * brightest(open));
}

} // namespace
} // namespace vdbeam
