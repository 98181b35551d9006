// Groups of lights: one pass finds the light of all of them, and which part is whose.
#include "support/lumpy_cloud.h"
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;
using surfaces::add_surface;
using surfaces::moved;
using surfaces::scaled;

/// The lights of the scene below, by group in the order of their names.
enum Lights { disk, lamps, rest, sun, group_count };
constexpr std::array<const char*, group_count> names{"disk", "lamps", "", "sun"};

/// A glowing core in a cloud, which stands on a ground beside a mirror, a ball of glass and one of
/// rough metal, under a sun, a sky, a point lamp in the cloud, a spot and a disk that shines.
/// `chosen`: lights of the other groups are left out; `grouped`: lights name their groups.
MemoryScene shot(const std::vector<Lights>& chosen, bool grouped) {
  MemoryScene scene = lumpy_cloud(20, 32);
  scene.scene.lights.clear();
  scene.scene.volumes[0].albedo = Rgb(0.95f);
  scene.scene.volumes[0].phase = henyey_greenstein(0.7);
  const auto has = [&](Lights group) {
    return std::find(chosen.begin(), chosen.end(), group) != chosen.end();
  };
  const auto add = [&](Lights group, LightType type) -> LightSettings& {
    LightSettings& light = scene.add_light(type);
    if (grouped)
      light.group = names[group];
    return light;
  };
  if (has(sun)) {
    LightSettings& light = add(sun, LightType::distant);
    light.direction = {0.3, -1, -0.4};
    light.irradiance = {2, 1.8f, 1.5f};
  }
  if (has(rest))
    add(rest, LightType::environment).radiance = {0.1f, 0.15f, 0.2f};
  if (has(lamps)) {
    LightSettings& inside = add(lamps, LightType::point);
    inside.position = {0.1, 0.3, 0.1};
    inside.intensity = {0.2f, 0.1f, 0.05f};
    LightSettings& spot = add(lamps, LightType::spot);
    spot.position = {-1.5, 1, 1};
    spot.direction = {1.5, -1, -1};
    spot.intensity = Rgb(2);
  }
  if (has(rest))
    scene.glow(uniform_field({1, 1, 1}, 1), box_map({1, 1, 1}, {-0.2, -0.1, -0.2}, {0.1, 0.2, 0.1}))
        .scale = 0.8;
  surfaces::Transform flat{3, 0, 0, 0, 0, 0, 3, -0.7, 0, -3, 0, 0};
  add_surface(scene, SurfaceShape::quad, flat, surfaces::diffuse(0.4));
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {0.45, -0.5, 0.4}),
              surfaces::glass(true));
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {-0.45, -0.5, 0.4}),
              surfaces::of_type(MaterialType::mirror));
  MaterialSettings metal = surfaces::of_type(MaterialType::conductor);
  metal.roughness = 0.3;
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {0, -0.5, 0.6}), metal);
  if (has(disk)) {
    SurfaceSettings& shining =
        add_surface(scene, SurfaceShape::disk, moved(scaled(0.3), {-1.2, 1.5, 0.5}, true),
                    surfaces::shining(4));
    if (grouped)
      shining.group = names[disk];
  }
  scene.look({0.5, 0.4, 3}, {0, -0.1, 0}, 30, 16, 16);
  return scene;
}

const std::vector<Lights> all_lights{disk, lamps, rest, sun};

/// The pictures of a few passes, and their work.
struct Passes {
  std::vector<PassImage> images;
  RenderStatistics statistics;
};

Passes render(MemoryScene scene, EstimatorType type, int passes) {
  scene.scene.render.estimator = type;
  const TestFrame frame(scene);
  const std::unique_ptr<PassRenderer> renderer = frame.estimator();
  Passes result;
  for (int pass = 0; pass < passes; ++pass)
    renderer->render_pass(pass, result.images.emplace_back(), result.statistics);
  return result;
}

double mean_of(const std::vector<Rgb>& pixels) {
  double sum = 0;
  for (const Rgb& pixel : pixels)
    sum += static_cast<double>(mean_component(pixel));
  return sum / static_cast<double>(pixels.size());
}

class LightGroups : public testing::TestWithParam<EstimatorType> {};

/// What is added up in another order is rounded otherwise.
TEST_P(LightGroups, AddUpToThePictureWithoutGroups) {
  const Passes grouped = render(shot(all_lights, true), GetParam(), 2);
  const Passes plain = render(shot(all_lights, false), GetParam(), 2);
  for (std::size_t pass = 0; pass < plain.images.size(); ++pass) {
    const PassImage &image = grouped.images[pass], &expected = plain.images[pass];
    ASSERT_EQ(image.groups.size(), group_count);
    EXPECT_TRUE(expected.groups.empty());
    for (std::size_t i = 0; i < image.direct.size(); ++i) {
      Rgb sum;
      for (const std::vector<Rgb>& group : image.groups)
        sum += group[i];
      for (int c = 0; c < 3; ++c) {
        const float whole = expected.total(i)[c], tolerance = 1e-4f * (std::abs(whole) + 0.01f);
        ASSERT_NEAR(image.total(i)[c], whole, tolerance) << "pass " << pass << ", pixel " << i;
        ASSERT_NEAR(sum[c], whole, tolerance) << "pass " << pass << ", pixel " << i;
      }
    }
  }
}

/// Groups cost no photon, no ray and no walk.
TEST_P(LightGroups, TakeNoMoreWork) {
  const RenderStatistics grouped = render(shot(all_lights, true), GetParam(), 2).statistics,
                         plain = render(shot(all_lights, false), GetParam(), 2).statistics;
  for (const auto work : {&RenderStatistics::light_paths, &RenderStatistics::photons_stored,
                          &RenderStatistics::light_collisions, &RenderStatistics::shadow_rays,
                          &RenderStatistics::contributions, &RenderStatistics::gather_walks,
                          &RenderStatistics::walk_collisions, &RenderStatistics::depth_profiles})
    EXPECT_EQ(grouped.*work, plain.*work);
}

/// Each group has what its lights give alone, within chance at one of ten thousand and the bias of
/// kernels, which depends on how many photons its lights get.
TEST_P(LightGroups, EachHasTheLightOfItsLights) {
  constexpr int passes = 12;
  const Passes grouped = render(shot(all_lights, true), GetParam(), passes);
  for (const Lights group : all_lights) {
    Samples of_group, alone;
    for (const PassImage& image : grouped.images)
      of_group.add(mean_of(image.groups[static_cast<std::size_t>(group)]));
    for (const PassImage& image : render(shot({group}, false), GetParam(), passes).images) {
      std::vector<Rgb> total;
      for (std::size_t i = 0; i < image.direct.size(); ++i)
        total.push_back(image.total(i));
      alone.add(mean_of(total));
    }
    EXPECT_GT(alone.mean(), 0.001);
    expect_same_mean(of_group, alone, GetParam() == EstimatorType::path ? 0 : 0.03 * alone.mean());
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, LightGroups,
                         testing::Values(EstimatorType::beam, EstimatorType::march,
                                         EstimatorType::gather, EstimatorType::path),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace vdbeam
