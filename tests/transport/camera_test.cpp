#include "camera/camera.h"

#include "support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

const RenderSpace world_space{{0, 0, 0}, 1};

/// At the origin, looking along -Z.
CameraSettings forward_camera() {
  CameraSettings camera;
  camera.position = {0, 0, 0};
  camera.look_at = {0, 0, -4};
  camera.fov = 60;
  return camera;
}

void expect_near(const Vec3d& a, const Vec3d& b, double error = 1e-12) {
  EXPECT_LT(length(a - b), error) << a.x << " " << a.y << " " << a.z;
}

/// Where a ray passes the plane at depth z.
Vec3d at_depth(const EyeRay& ray, double z) {
  return ray.origin + ray.direction * ((-z - ray.origin.z) / ray.direction.z);
}

TEST(CameraProjection, FocalLengthAndFilmWidth) {
  CameraSettings settings = forward_camera();
  settings.focal_length = 50;
  settings.film_width = 36;
  const Camera camera(settings, {200, 100}, world_space);
  // At a depth of 50 the picture is as wide as the film.
  expect_near(at_depth(camera.ray(200, 0), 50), {18, 9, -50});
  expect_near(at_depth(camera.ray(0, 100), 50), {-18, -9, -50});
}

TEST(CameraProjection, ShiftMovesThePictureByItsSize) {
  CameraSettings settings = forward_camera();
  settings.focal_length = 50;
  settings.shift_x = 0.25;
  settings.shift_y = -0.5;
  const Camera camera(settings, {200, 100}, world_space);
  expect_near(at_depth(camera.ray(0, 0), 50), {-9, 0, -50});
  expect_near(at_depth(camera.ray(200, 100), 50), {27, -18, -50});
}

TEST(CameraProjection, WidePixelsSeeWiderPictures) {
  ImageSettings image;
  image.width = 200;
  image.height = 100;
  image.pixel_aspect = 2;
  const double tangent = std::tan(std::numbers::pi / 6);
  const Camera camera(forward_camera(), image, world_space);
  expect_near(at_depth(camera.ray(200, 0), 1), {4 * tangent, tangent, -1});
  CameraSettings film = forward_camera(); // whose width says what the picture holds
  film.focal_length = 50;
  expect_near(at_depth(Camera(film, image, world_space).ray(200, 0), 50), {18, 4.5, -50});
}

TEST(CameraProjection, OverscanAddsPixelsAround) {
  ImageSettings image;
  image.width = 200;
  image.height = 100;
  const Camera plain(forward_camera(), image, world_space);
  image.overscan = 30;
  const Camera camera(forward_camera(), image, world_space);
  EXPECT_EQ(camera.width(), 260);
  EXPECT_EQ(camera.height(), 160);
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {37.5, 81.0}, {200.0, 100.0}})
    expect_near(camera.ray(x + 30, y + 30).direction, plain.ray(x, y).direction);
  expect_near(camera.ray(0, 0).direction, plain.ray(-30, -30).direction);
}

TEST(CameraProjection, ParallelRays) {
  CameraSettings settings = forward_camera();
  settings.projection = Projection::orthographic;
  settings.view_height = 3;
  settings.shift_x = 0.5;
  const Camera camera(settings, {200, 100}, {{1, 0, 0}, 2}); // render space: 2 (p - (1, 0, 0))
  const EyeRay ray = camera.ray(200, 0);
  expect_near(ray.direction, {0, 0, -1});
  expect_near(ray.origin, {2 * (6.0 - 1), 2 * 1.5, 0});
  EXPECT_TRUE(camera.has_own_origins());
}

TEST(CameraProjection, PanoramaSeesAllAround) {
  CameraSettings settings = forward_camera();
  settings.projection = Projection::panorama;
  const Camera camera(settings, {200, 100}, world_space);
  expect_near(camera.ray(100, 50).direction, {0, 0, -1});
  expect_near(camera.ray(150, 50).direction, {1, 0, 0}); // a quarter to the right
  expect_near(camera.ray(0, 50).direction, {0, 0, 1});
  expect_near(camera.ray(70, 0).direction, {0, 1, 0});
  expect_near(camera.ray(100, 75).direction, normalize(Vec3d(0, -1, -1)));
}

TEST(CameraLens, AllRaysOfAPointMeetInThePlaneOfFocus) {
  CameraSettings settings = forward_camera();
  settings.lens_radius = 0.2;
  settings.focus_distance = 3;
  const Camera camera(settings, {1, 1}, world_space);
  // The pixel's corner and size at the plane of focus.
  const Vec3d corner = at_depth(camera.ray(0, 0), 3), opposite = at_depth(camera.ray(1, 1), 3);
  Rng rng({}, RngStage::test, 1), jitter = rng;
  double farthest = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = jitter.uniform(), y = jitter.uniform();
    jitter.uniform(), jitter.uniform();
    const EyeRay ray = camera.sample(0, 0, rng);
    const Vec3d size = opposite - corner;
    expect_near(at_depth(ray, 3), corner + Vec3d(size.x * x, size.y * y, 0), 1e-9);
    farthest = std::max(farthest, length(ray.origin));
    EXPECT_NEAR(length(ray.direction), 1, 1e-12);
  }
  EXPECT_LT(farthest, 0.2);
  EXPECT_GT(farthest, 0.198);
}

/// A disc's points lie r / sqrt(2) off its centre in the root mean square, so at twice the focus a
/// point is blurred by that of the lens itself.
TEST(CameraLens, BlursByTheThinLensFormula) {
  CameraSettings settings = forward_camera();
  settings.focal_length = 50;
  settings.f_stop = 2.5; // a lens 20 mm wide
  settings.unit_in_mm = 10;
  settings.focus_distance = 7;
  const Camera camera(settings, {1, 1}, world_space);
  const double radius = 1;
  Rng rng({}, RngStage::test, 2);
  test::Samples squares;
  for (int i = 0; i < 20000; ++i) {
    const EyeRay ray = camera.sample(0, 0, rng);
    const Vec3d sharp = at_depth(ray, 7) * 2, off = at_depth(ray, 14) - sharp;
    squares.add(dot(off, off));
  }
  test::expect_mean(squares, radius * radius / 2);
}

/// A regular polygon with n corners at r: mean of the squared distance r^2 / 6 (2 + cos(2 pi / n)),
/// and nothing beyond the edges.
TEST(CameraLens, BladesMakeAPolygon) {
  for (const int blades : {3, 5, 8}) {
    const Lens lens(2, blades, 20);
    Rng rng({}, RngStage::test, 3);
    test::Samples squares, x;
    const double step = 2 * std::numbers::pi / blades, inside = 2 * std::cos(step / 2);
    for (int i = 0; i < 20000; ++i) {
      const Vec3d p = lens.sample(rng.uniform(), rng.uniform());
      squares.add(dot(p, p));
      x.add(p.x);
      for (int b = 0; b < blades; ++b) {
        const double normal = 20 * std::numbers::pi / 180 + (b + 0.5) * step;
        ASSERT_LE(p.x * std::cos(normal) + p.y * std::sin(normal), inside + 1e-12);
      }
    }
    test::expect_mean(squares, 4.0 / 6 * (2 + std::cos(step)));
    test::expect_mean(x, 0);
  }
}

TEST(CameraFilter, DrawsByItsProfile) {
  for (const PixelFilter filter : {PixelFilter::gaussian, PixelFilter::blackman_harris}) {
    const FilterSampler sampler(filter, 3);
    const auto profile = [&](double x) {
      const double phase = 2 * std::numbers::pi * (x / 3 + 0.5);
      return filter == PixelFilter::gaussian
                 ? std::exp(-2 * x * x) // sigma: a sixth of 3
                 : 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) -
                       0.01168 * std::cos(3 * phase);
    };
    double mass = 0, square = 0;
    for (double x = -1.5 + 5e-4; x < 1.5; x += 1e-3) {
      mass += profile(x);
      square += x * x * profile(x);
    }
    test::Samples offsets, squares;
    for (int i = 0; i < 10000; ++i) {
      const double x = sampler.offset((i + 0.5) / 10000) - 0.5;
      EXPECT_LE(std::abs(x), 1.5);
      offsets.add(x);
      squares.add(x * x);
    }
    EXPECT_NEAR(offsets.mean(), 0, 1e-4);
    EXPECT_NEAR(squares.mean(), square / mass, 1e-3 * square / mass);
  }
  EXPECT_EQ(FilterSampler(PixelFilter::box, 0).offset(0.3), 0.3);
  EXPECT_DOUBLE_EQ(FilterSampler(PixelFilter::box, 2).offset(0.75), 1);
}

/// Cameras of all kinds at random places: no box that a ray meets is said to be out of view, and of
/// those that none meets some are.
TEST(CameraView, NeverDeniesWhatItSees) {
  Rng rng({}, RngStage::test, 4);
  const auto number = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng.uniform());
  };
  int denied = 0;
  for (int i = 0; i < 400; ++i) {
    CameraSettings settings;
    settings.position = {number(-3, 3), number(-3, 3), number(-3, 3)};
    settings.look_at = {number(-9, 9), number(-9, 9), number(-9, 9)};
    settings.fov = number(5, 60);
    settings.shift_x = number(-0.5, 0.5);
    settings.view_height = number(0.5, 3);
    settings.projection = i % 2 ? Projection::perspective : Projection::orthographic;
    settings.lens_radius = i % 4 == 1 ? number(0, 0.5) : 0;
    settings.focus_distance = number(1, 6);
    ImageSettings image;
    image.width = 40;
    image.height = 30;
    image.filter = PixelFilter::gaussian;
    image.filter_width = 4;
    const Camera camera(settings, image, world_space);
    const Boxd box{{0, 0, 0}, {0.5, 0.7, 0.4}};
    bool met = false;
    for (int r = 0; r < 300; ++r) {
      const EyeRay ray =
          camera.sample(static_cast<int>(number(0, 40)), static_cast<int>(number(0, 30)), rng);
      double t0 = 0, t1 = 1e9;
      for (int a = 0; a < 3; ++a) {
        const double x = (box.lower[a] - ray.origin[a]) / ray.direction[a];
        const double y = (box.upper[a] - ray.origin[a]) / ray.direction[a];
        t0 = std::max(t0, std::min(x, y));
        t1 = std::min(t1, std::max(x, y));
      }
      met = met || t0 < t1;
    }
    EXPECT_TRUE(!met || camera.may_see(box)) << i;
    denied += !camera.may_see(box);
  }
  EXPECT_GT(denied, 100);
}

/// A point on a pixel position's ray is projected to that position, whatever the camera.
TEST(CameraProjection, ProjectingIsTheInverseOfRays) {
  const RenderSpace space{{3, -2, 1}, 0.25};
  for (const Projection projection :
       {Projection::perspective, Projection::orthographic, Projection::panorama})
    for (const double shift : {0.0, 0.3}) {
      CameraSettings settings = forward_camera();
      settings.projection = projection;
      settings.position = {1, 2, 3};
      settings.look_at = {-2, 1, -5};
      settings.view_height = 7;
      settings.shift_x = shift;
      settings.shift_y = -shift;
      ImageSettings image{60, 40};
      image.pixel_aspect = 1.5;
      image.overscan = 5;
      const Camera camera(settings, image, space);
      for (const auto& [px, py] : {std::pair{5.25, 5.25}, {31.25, 20.5}, {64.0, 44.5}}) {
        const EyeRay ray = camera.ray(px, py);
        const auto found = camera.project(ray.origin + ray.direction * 3.7);
        ASSERT_TRUE(found);
        double x = (*found)[0];
        if (projection == Projection::panorama) // which closes on itself
          x += 60 * std::round((px - x) / 60);
        EXPECT_NEAR(x, px, 1e-9);
        EXPECT_NEAR((*found)[1], py, 1e-9);
      }
      if (projection == Projection::perspective) {
        EXPECT_FALSE(camera.project(camera.origin() - camera.ray(35, 25).direction));
      }
    }
}

} // namespace
} // namespace vdbeam
