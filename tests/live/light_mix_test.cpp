// Images under other strengths of the lights, mixed from the images of single lights.
#include "live/light_mix.h"
#include "support/statistics.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

Scene lit_fog() {
  return parse_scene(R"(
[image]
width = 24
height = 16
[camera]
position = [0, 0.5, 5]
look_at = [0, 0, 0]
fov = 34
[[volume]]
shape = "sphere"
extinction = 4
albedo = 0.9
phase = { type = "henyey_greenstein", g = 0.5 }
[[light]]
type = "distant"
direction = [-1, -1, -0.5]
irradiance = [3, 2, 1]
[[light]]
type = "sky"
[[mesh]]
type = "disk"
translate = [2.2, 1.5, 0]
rotate = [0, -90, 0]
material = { type = "emissive", radiance = 6 }
[[mesh]]
type = "quad"
scale = 6
translate = [0, -1.5, 0]
rotate = [-90, 0, 0]
material = { type = "diffuse", albedo = 0.4 }
[render]
estimator = "path"
passes = 16
)",
                     "fog.toml");
}

/// Mean brightness of the 24 blocks of 4 x 4 pixels.
std::vector<double> blocks(const Image& image) {
  std::vector<double> means(24);
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& data = image.find(name)->data;
    for (std::size_t i = 0; i < data.size(); ++i)
      means[i / 24 / 4 * 6 + i % 24 / 4] += static_cast<double>(data[i]) / 48;
  }
  return means;
}

Image render_with_seed(Scene scene, std::uint64_t seed) {
  scene.render.seed = seed;
  return render(scene).image;
}

std::optional<LightMix> mix_of(const Scene& before, const Scene& after) {
  return LightMix::between(LightMix::with_groups(before), after);
}

TEST(LightMix, IsTheImageOfTheEditedScene) {
  const Scene before = lit_fog();
  Scene after = before;
  after.lights[0].exposure = -1.5;
  after.lights[0].kelvin = 3000;
  after.lights[1].radiance = {0.2f, 2, 3};
  after.surfaces[0].material.radiance = {20, 1, 5};
  const std::optional<LightMix> mix = mix_of(before, after);
  ASSERT_TRUE(mix);
  constexpr int renders = 6;
  std::vector<test::Samples> mixed(24), direct(24);
  for (std::uint64_t seed = 1; seed <= renders; ++seed) {
    const std::optional<Image> image =
        mix->apply(render_with_seed(LightMix::with_groups(before), seed));
    ASSERT_TRUE(image);
    const auto a = blocks(*image), b = blocks(render_with_seed(after, renders + seed));
    for (std::size_t i = 0; i < a.size(); ++i) {
      mixed[i].add(a[i]);
      direct[i].add(b[i]);
    }
  }
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    test::expect_same_mean(mixed[i], direct[i]);
    test::expect_power(mixed[i], 0.05 * mixed[i].mean() + 1e-3);
  }
}

TEST(LightMix, WithoutChangesIsTheImage) {
  const Scene scene = LightMix::with_groups(lit_fog());
  const Image image = render(scene).image;
  const std::optional<Image> same = LightMix().apply(image);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->channels.size(), 4U);
  for (const char* name : {"R", "G", "B", "A"})
    EXPECT_EQ(same->find(name)->data, image.find(name)->data) << name;
}

TEST(LightMix, LeavesOtherEditsToARender) {
  const Scene before = lit_fog();
  const std::vector<std::pair<const char*, std::function<void(Scene&)>>> edits{
      {"a direction", [](Scene& s) { s.lights[0].direction.x = 0; }},
      {"an albedo", [](Scene& s) { s.volumes[0].albedo = Rgb(0.5f); }},
      {"a camera", [](Scene& s) { s.camera.position.x += 1; }},
      {"a light less", [](Scene& s) { s.lights.pop_back(); }},
      {"a light more", [](Scene& s) { s.lights.push_back(s.lights[0]); }},
      {"the colour of a lamp's disk", [](Scene& s) { s.surfaces[0].material.albedo = Rgb(0.1f); }}};
  for (const auto& [name, edit] : edits) {
    Scene after = before;
    edit(after);
    EXPECT_FALSE(mix_of(before, after)) << name;
  }
}

TEST(LightMix, GoesOnWhereOnlyOutputsDiffer) {
  const Scene before = lit_fog();
  const std::vector<std::pair<const char*, std::function<void(Scene&)>>> edits{
      {"a group", [](Scene& s) { s.lights[0].group = "key"; }},
      {"a group of a lamp", [](Scene& s) { s.surfaces[0].group = "lamp"; }},
      {"a layer", [](Scene& s) { s.layers.push_back({"depth"}); }},
      {"a deep image", [](Scene& s) { s.image.deep = true; }},
      {"Cryptomatte", [](Scene& s) { s.image.cryptomatte = true; }},
      {"a compression", [](Scene& s) { s.image.compression = Compression::piz; }}};
  for (const auto& [name, edit] : edits) {
    Scene after = before;
    edit(after);
    const std::optional<LightMix> mix = mix_of(before, after);
    ASSERT_TRUE(mix) << name;
    EXPECT_TRUE(mix->changes_nothing()) << name;
  }
}

TEST(LightMix, SwitchesLightsOff) {
  const Scene before = lit_fog();
  Scene after = before;
  after.lights[0].irradiance = Rgb();
  after.surfaces[0].material.radiance = Rgb();
  const std::optional<LightMix> mix = mix_of(before, after);
  ASSERT_TRUE(mix);
  EXPECT_FALSE(mix->changes_nothing());
}

TEST(LightMix, RendersNoDeepSamples) {
  Scene scene = lit_fog();
  scene.image.deep = scene.image.cryptomatte = true;
  const Scene grouped = LightMix::with_groups(scene);
  EXPECT_FALSE(grouped.image.deep);
  EXPECT_FALSE(grouped.image.cryptomatte);
  EXPECT_EQ(grouped.image.width, scene.image.width);
}

TEST(LightMix, CannotBrightenWhatWasDark) {
  Scene before = lit_fog();
  before.lights[0].irradiance = {3, 0, 1};
  Scene after = before;
  after.lights[0].irradiance = {3, 1, 1};
  EXPECT_FALSE(mix_of(before, after));
}

TEST(LightMix, LeavesShadowCatchersToARender) {
  Scene before = lit_fog(), after;
  before.surfaces[1].material = {};
  before.surfaces[1].material.type = MaterialType::shadow_catcher;
  after = before;
  after.lights[0].exposure = 1;
  EXPECT_FALSE(mix_of(before, after));
}

} // namespace
} // namespace vdbeam
