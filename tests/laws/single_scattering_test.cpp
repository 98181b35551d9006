#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

// Single scattering of a light in a homogeneous box, against quadrature; and media that only
// absorb, against the exponential.
namespace vdbeam {
namespace {

using test::MemoryScene;

constexpr double sigma = 2.5, albedo = 0.8, g = 0.4;
const Vec3d lower{-0.6, -0.4, -0.5}, upper{0.7, 0.5, 0.4};

/// Distances at which a line enters and leaves the box, none below 0; both 0 where it misses.
std::pair<double, double> chord(const Vec3d& o, const Vec3d& d, double t_end) {
  double begin = 0, end = t_end;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      if (o[a] < lower[a] || o[a] > upper[a])
        return {0, 0};
      continue;
    }
    const double x = (lower[a] - o[a]) / d[a], y = (upper[a] - o[a]) / d[a];
    begin = std::max(begin, std::min(x, y));
    end = std::min(end, std::max(x, y));
  }
  return begin < end ? std::pair{begin, end} : std::pair{0.0, 0.0};
}

double transmittance(const Vec3d& from, const Vec3d& to) {
  const double distance = length(to - from);
  const auto [a, b] = chord(from, (to - from) / distance, distance);
  return std::exp(-sigma * (b - a));
}

double henyey_greenstein(double cosine) {
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// Share of a spot light's intensity at the cosine of an angle to its axis
/// (docs/theory/transport.md).
double spot_share(const LightSettings& light, double cosine) {
  if (light.type != LightType::spot)
    return 1;
  const double degree = std::numbers::pi / 180;
  const double edge = std::cos(light.cone_angle * degree);
  const double full = std::cos((light.cone_angle - light.cone_falloff) * degree);
  const double t = std::clamp((cosine - edge) / (full - edge), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Radiance of single scattering along o + t d by the midpoint rule; tan substitution around the
/// point nearest to the light (Kulla and Fajardo 2012) tames 1 / r^2.
double exact_radiance(const LightSettings& light, const Vec3d& o, const Vec3d& d) {
  const auto [a, b] = chord(o, d, 1e9);
  const double nearest = dot(light.position - o, d);
  const double h = length(light.position - (o + d * nearest));
  const double angle_a = std::atan((a - nearest) / h), angle_b = std::atan((b - nearest) / h);
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double angle = angle_a + (i + 0.5) / steps * (angle_b - angle_a);
    const double t = nearest + h * std::tan(angle);
    const Vec3d x = o + d * t, travel = normalize(x - light.position);
    // dt / r^2 = d angle / h
    const double share = spot_share(light, dot(travel, normalize(light.direction)));
    sum += share * std::exp(-sigma * (t - a)) * transmittance(x, light.position) *
           henyey_greenstein(-dot(travel, d)) * sigma * albedo / h;
  }
  return sum * (angle_b - angle_a) / steps;
}

MemoryScene box(const LightSettings& light) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box(lower, upper);
  volume.extinction = sigma;
  volume.albedo = {static_cast<float>(albedo), static_cast<float>(albedo / 2), 0};
  volume.phase = test::henyey_greenstein(g);
  scene.scene.lights.push_back(light);
  scene.scene.render.max_bounces = 1;
  return scene;
}

LightSettings point(const Vec3d& position) {
  LightSettings light;
  light.type = LightType::point;
  light.position = position;
  light.intensity = {3, 3, 3};
  return light;
}

LightSettings spot(const Vec3d& position) {
  LightSettings light = point(position);
  light.type = LightType::spot;
  light.direction = Vec3d(0.1, 0.05, -0.05) - position;
  light.cone_angle = 25;
  light.cone_falloff = 15;
  return light;
}

struct View {
  Vec3d from, to;
};
const std::vector<View>& views() {
  static const std::vector<View> all{{{0.3, 0.2, 3}, {0.02, 0.1, 0}},
                                     {{-3, 1, 0.5}, {0.1, -0.05, 0.1}},
                                     {{0.2, 0.1, 0.3}, {0, 0, -0.5}}}; // the last from inside
  return all;
}

/// What finds the light: shadow rays, which are the same for both photon estimators, or photons.
struct Finder {
  const char* name;
  EstimatorType estimator;
  DirectLight direct;
  double bias; ///< of kernels, in parts of the radiance
};

void expect_quadrature(const LightSettings& light, const Finder& finder) {
  for (const View& view : views()) {
    MemoryScene scene = box(light);
    scene.look(view.from, view.to, 0.01, 8, 8);
    RenderSettings& render = scene.scene.render;
    render.direct = finder.direct;
    render.photons = 100000;
    render.kernel = KernelRadius::fixed;
    render.radius = 0.05;
    render.alpha = 1;
    const bool photons = finder.direct == DirectLight::photons;
    const test::PassMeans means = test::render_passes(scene, finder.estimator, photons ? 32 : 100);
    const double expected = 3 * exact_radiance(light, view.from, normalize(view.to - view.from));
    test::expect_mean(means.total[0], expected, finder.bias * expected, 2e-4);
    test::expect_mean(means.total[1], expected / 2, finder.bias * expected / 2, 2e-4);
    EXPECT_EQ(means.total[2].mean(), 0);
    test::expect_power(means.total[0], 0.02 * expected);
  }
}

class SingleScattering : public testing::TestWithParam<Finder> {};
/// Beside a light in the medium kernels blur 1 / distance^2: not for photons.
class SingleScatteringByShadowRays : public SingleScattering {};

TEST_P(SingleScattering, PointLightOutside) {
  expect_quadrature(point({1.2, 0.9, 1.0}), GetParam());
}

TEST_P(SingleScatteringByShadowRays, PointLightInside) {
  expect_quadrature(point({0.3, -0.2, -0.1}), GetParam());
}

TEST_P(SingleScattering, SpotLightOutside) {
  expect_quadrature(spot({0.9, 1.1, 0.8}), GetParam());
}

TEST_P(SingleScatteringByShadowRays, SpotLightInside) {
  expect_quadrature(spot({0.35, -0.25, -0.2}), GetParam());
}

std::string finder_name(const testing::TestParamInfo<Finder>& finder) {
  return finder.param.name;
}
constexpr Finder path{"path", EstimatorType::path, DirectLight::sampled, 0};
constexpr Finder shadow_rays{"shadow_rays", EstimatorType::beam, DirectLight::sampled, 0};

INSTANTIATE_TEST_SUITE_P(
    Finders, SingleScattering,
    testing::Values(path, shadow_rays,
                    Finder{"beam", EstimatorType::beam, DirectLight::photons, 0.01},
                    Finder{"march", EstimatorType::march, DirectLight::photons, 0.02}),
    finder_name);
INSTANTIATE_TEST_SUITE_P(Finders, SingleScatteringByShadowRays, testing::Values(path, shadow_rays),
                         finder_name);

TEST(Absorption, OnlyTheBackgroundIsLeft) {
  for (const EstimatorType estimator :
       {EstimatorType::path, EstimatorType::beam, EstimatorType::march}) {
    MemoryScene scene = box(point({0, 0, 0}));
    scene.scene.volumes[0].albedo = Rgb(0);
    scene.scene.volumes[0].extinction_scale = {1, 0.5f, 0};
    scene.scene.render.max_bounces.reset();
    scene.add_light(LightType::environment).radiance = {2, 3, 4};
    for (const View& view : views()) {
      scene.look(view.from, view.to, 1e-3, 2, 2);
      const auto [a, b] = chord(view.from, normalize(view.to - view.from), 1e9);
      const test::PassMeans means = test::render_passes(scene, estimator, 2);
      for (std::size_t c = 0; c < 3; ++c) {
        const double scale[] = {1, 0.5, 0};
        const double expected =
            (2 + static_cast<double>(c)) * std::exp(-sigma * scale[c] * (b - a));
        EXPECT_NEAR(means.total[c].mean(), expected, 1e-4 * expected);
        EXPECT_EQ(means.direct[c].mean() + means.indirect[c].mean(), 0);
      }
    }
  }
}

} // namespace
} // namespace vdbeam
