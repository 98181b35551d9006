// What matt surfaces show of light that came by other ways than straight is fitted over pixels:
// even light and light that changes steadily stay as they are, other surfaces do not count, noise
// falls.
#include "shading/surface_fit.h"

#include "choose/schedule.h"
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace vdbeam {
namespace {

using namespace test;

constexpr int width = 24;

/// A scene whose camera looks straight at the plane z = 0 from a distance of 10.
MemoryScene plane_scene() {
  MemoryScene scene;
  surfaces::add_surface(scene, SurfaceShape::quad, surfaces::scaled(20), surfaces::diffuse(0.5));
  scene.add_light(LightType::environment);
  scene.look({0, 0, 10}, {0, 0, 0}, 20, width, width);
  return scene;
}

/// Fits the light of a plane whose pixels are what `pixel(x, y)` returns, seen through `tr`.
template <class Pixel>
PassImage fit_of_pixels(const TestFrame& frame, int pass, float tr, const Pixel& pixel) {
  PassSpec spec;
  spec.expected_passes = expected_passes(pass);
  const auto [narrow, wide] = surface_fit_radii(pass);
  spec.surface_fit_radius = narrow;
  spec.wide_surface_fit_radius = wide;
  SurfaceFit fit(frame.input(), spec);
  PassImage image;
  image.resize(width, width);
  const double step =
      frame.camera.pixel_width(width / 2.0, width / 2.0, 10 * frame.world.space.scale);
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) {
      SeenSurface seen = pixel(x, y);
      seen.position = Vec3f(Vec3d{x * step, y * step, 0});
      seen.normal = {0, 0, 1};
      const auto i = static_cast<std::size_t>(y * width + x);
      fit.set(i, seen, Rgb(tr));
      image.background[i] = seen.fitted().sum() * tr;
    }
  fit.apply({0, 0, width, width}, image);
  return image;
}

/// The same with light(x, y) on a plane that is cut in two surfaces at `cut`. `straight`: it is of
/// lights, by shadow rays with this variance; absent: of surfaces.
template <class Light>
PassImage fit_of(const TestFrame& frame, int pass, int cut, const Light& light,
                 std::optional<float> straight = {}) {
  return fit_of_pixels(frame, pass, 0.8f, [&](int x, int y) {
    SeenSurface seen;
    (straight ? seen.straight : seen.smooth) =
        GroupedLight(Rgb(static_cast<float>(light(x, y))), -1);
    seen.straight_variance = straight.value_or(0);
    seen.albedo = Rgb(0.5f);
    seen.surface = x < cut ? 0 : 1;
    return seen;
  });
}

TEST(SurfaceFit, KeepsWhatChangesSteadilyAndEdgesBetweenSurfaces) {
  const MemoryScene scene = plane_scene();
  const TestFrame frame(scene);
  const auto light = [](int x, int y) { return (x < 10 ? 1 : 7) + 0.05 * x - 0.03 * y; };
  for (const int pass : {0, 8, 50, 1000}) {
    const PassImage image = fit_of(frame, pass, 10, light);
    for (int y = 0; y < width; ++y)
      for (int x = 0; x < width; ++x)
        EXPECT_NEAR(image.background[static_cast<std::size_t>(y * width + x)].x, 0.4 * light(x, y),
                    0.003)
            << pass << ": " << x << ", " << y;
  }
}

TEST(SurfaceFit, LessensNoiseLessFromPassToPass) {
  const MemoryScene scene = plane_scene();
  const TestFrame frame(scene);
  const auto light = [](int x, int y) { return 1 + lattice_noise(x, y, 0) - 0.5; };
  const auto spread = [&](int pass) {
    const PassImage image = fit_of(frame, pass, 0, light);
    double sum = 0;
    for (const Rgb& value : image.background)
      sum += (static_cast<double>(value.x) - 0.4) * (static_cast<double>(value.x) - 0.4);
    return sum / (width * width);
  };
  const double whole = 0.16 / 12;
  EXPECT_LT(spread(0), 0.12 * whole);
  EXPECT_LT(spread(0), spread(20));
  EXPECT_LT(spread(20), spread(100));
  EXPECT_LT(spread(1000), 0.9 * whole);
}

/// Mean squared distance from `truth(x, y)`, in units of what is set.
template <class Truth>
double error_of(const PassImage& image, const Truth& truth) {
  double sum = 0;
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) {
      const auto value =
          static_cast<double>(image.background[static_cast<std::size_t>(y * width + x)].x) / 0.4;
      sum += (value - truth(x, y)) * (value - truth(x, y)) / (width * width);
    }
  return sum;
}

constexpr double noise_variance = 1.0 / 12;
double noise_at(int x, int y) {
  return lattice_noise(x, y, 0) - 0.5;
}

TEST(SurfaceFit, EvensOutMoreWhereLightIsEvenThanWhereItBends) {
  const MemoryScene scene = plane_scene();
  const TestFrame frame(scene);
  const auto even = [](int, int) { return 3.0; };
  const auto bends = [](int x, int) { return 3 + 2 * std::cos(x * 0.5); };
  const auto noisy = [](const auto& truth) {
    return [=](int x, int y) { return truth(x, y) + noise_at(x, y); };
  };
  const double flat = error_of(fit_of(frame, 0, 0, noisy(even)), even) / noise_variance;
  EXPECT_LT(flat, 0.04); // narrow planes alone leave 0.08
  const auto without_noise = error_of(fit_of(frame, 0, 0, bends), bends);
  const auto with_noise = error_of(fit_of(frame, 0, 0, noisy(bends)), bends);
  EXPECT_LT(without_noise, 0.15); // wide planes would leave the variance of the wave, 2
  EXPECT_LT(with_noise, without_noise + 0.15 * noise_variance + 0.05);
}

TEST(SurfaceFit, KeepsShadowsThatShadowRaysSeeWithoutNoise) {
  const MemoryScene scene = plane_scene();
  const TestFrame frame(scene);
  const auto shadow = [](int x, int y) { return x + y < 20 ? 0.0 : 5.0; };
  EXPECT_LT(error_of(fit_of(frame, 0, 0, shadow, 0.0f), shadow), 1e-10);
}

TEST(SurfaceFit, EvensOutTheNoiseOfShadowRaysBesideShadows) {
  const MemoryScene scene = plane_scene();
  const TestFrame frame(scene);
  const auto variance = static_cast<float>(noise_variance);
  const auto shadow = [](int x, int) { return x < 8 ? 0.0 : 5.0; };
  const auto noisy = [&](int x, int y) { return shadow(x, y) + noise_at(x, y); };
  const PassImage image = fit_of(frame, 0, 0, noisy, variance);
  double near = 0,
         far = 0; // pixels that planes across the edge of the shadow would blur, and others
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) {
      const double off =
          static_cast<double>(image.background[static_cast<std::size_t>(y * width + x)].x) / 0.4 -
          shadow(x, y);
      (std::abs(x - 7.5) < 4 ? near : far) += off * off;
    }
  EXPECT_LT(near / (8 * width), 2 * noise_variance);
  EXPECT_LT(far / ((width - 8) * width), 0.3 * noise_variance);
}

/// Light of two sides of an edge whose samples vary by this, on a glossy surface whose colour
/// differs from pixel to pixel.
TEST(SurfaceFit, EvensOutGlossyLightAsFarAsItIsNoise) {
  MemoryScene scene = plane_scene();
  MaterialSettings metal = surfaces::of_type(MaterialType::standard);
  metal.metal = 1;
  surfaces::add_surface(scene, SurfaceShape::sphere, surfaces::scaled(0.1), metal);
  const TestFrame frame(scene);
  const auto light = [](int x, int) { return x < 12 ? 1.0 : 5.0; };
  const auto color = [](int x, int y) { return (x + y) % 2 == 0 ? 0.2f : 0.8f; };
  const auto error = [&](double noise) {
    const PassImage image = fit_of_pixels(frame, 0, 1, [&](int x, int y) {
      SeenSurface seen;
      seen.gloss = {Rgb(static_cast<float>(light(x, y) + noise * noise_at(x, y))), -1};
      seen.gloss_variance = static_cast<float>(noise * noise * noise_variance);
      seen.gloss_color = Rgb(color(x, y));
      seen.albedo = Rgb(0.3f);
      seen.surface = 0;
      return seen;
    });
    double sum = 0;
    for (int y = 0; y < width; ++y)
      for (int x = 0; x < width; ++x) {
        const Rgb& value = image.background[static_cast<std::size_t>(y * width + x)];
        const double off = static_cast<double>(value.x / color(x, y)) - light(x, y);
        sum += off * off / (width * width);
      }
    return sum;
  };
  EXPECT_LT(error(0), 1e-9);
  EXPECT_LT(error(1), 0.35 * noise_variance);
}

/// A pixel of a region has the bits that it has in the whole picture.
TEST(SurfaceFit, ARegionIsAPartOfThePicture) {
  MemoryScene scene = plane_scene();
  scene.add_box({-1, -1, 0.5}, {1, 1, 1.5}).extinction = 2;
  scene.scene.render.photons = 2000;
  for (const EstimatorType type : {EstimatorType::beam, EstimatorType::gather}) {
    scene.scene.render.estimator = type;
    const TestFrame frame(scene);
    PassImage whole, part;
    RenderStatistics uncounted;
    make_pass_renderer(type, frame.input())->render_pass(0, whole, uncounted);
    EstimatorInput input = frame.input();
    input.window = {6, 9, 15, 14};
    make_pass_renderer(type, input)->render_pass(0, part, uncounted);
    for (int y = input.window.y0; y < input.window.y1; ++y)
      for (int x = input.window.x0; x < input.window.x1; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        for (int c = 0; c < 3; ++c)
          EXPECT_EQ(whole.total(i)[c], part.total(i)[c]) << x << ", " << y;
      }
  }
}

} // namespace
} // namespace vdbeam
