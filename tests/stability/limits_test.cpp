// Sizes, times and magnitudes at the ends of their ranges.
#include "film/film.h"
#include "machine/memory.h"
#include "plan/memory_check.h"
#include "plan/plan.h"
#include "stability/stability_scene.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"
#include "volume_factory.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

using namespace test;

constexpr std::uint64_t gigabyte = 1000000000;

/// What check_memory says of a scene of one dense volume on a machine of this size; empty: nothing.
std::string complaint(const Scene& scene, std::uint64_t granted) {
  try {
    const std::vector<VolumeFacts> facts(scene.volumes.size(), {false, 1000});
    check_memory(scene, plan_stages(scene, facts), granted);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Memory, ABillionPhotonsAreRefused) {
  MemoryScene scene = box_scene(1);
  add_sky(scene);
  scene.scene.render.photons = 1000000000;
  EXPECT_EQ(complaint(scene.scene, 16 * gigabyte),
            "scene: render.photons: a map of 1000000000 photons would take 64.0 GB of the 16.0 GB "
            "that this machine grants: use fewer photons and more passes, which give the same "
            "image");
  EXPECT_EQ(complaint(scene.scene, 128 * gigabyte), "");
}

TEST(Memory, MorePhotonsThanNumbersAreRefused) {
  MemoryScene scene = box_scene(1);
  add_sky(scene);
  for (const std::uint64_t photons : {std::uint64_t(5) << 30, ~std::uint64_t(0)}) {
    scene.scene.render.photons = photons;
    EXPECT_NE(complaint(scene.scene, ~std::uint64_t(0)), "") << photons;
  }
}

TEST(Memory, AThousandGroupsOfLightsAreRefusedOrFit) {
  MemoryScene scene = box_scene(1);
  scene.scene.image = {3840, 2160};
  for (int i = 0; i < 1000; ++i) {
    add_sky(scene);
    scene.scene.lights.back().group = fmt::format("g{}", i);
  }
  EXPECT_NE(complaint(scene.scene, 64 * gigabyte), "");
  EXPECT_EQ(complaint(scene.scene, 1024 * gigabyte), "");
}

TEST(Memory, AThousandLayersAreRefusedOrFit) {
  MemoryScene scene = box_scene(1);
  scene.scene.image = {3840, 2160};
  scene.scene.volumes.resize(250, scene.scene.volumes[0]); // of four channels each
  scene.scene.layers.push_back({"volumes"});
  EXPECT_EQ(complaint(scene.scene, 64 * gigabyte),
            "scene: image: 3840 x 2160 pixels with 1000 channels of layers would take 168.1 GB of "
            "the 64.0 GB that this machine grants: render a smaller image or fewer layers");
  EXPECT_EQ(complaint(scene.scene, 1024 * gigabyte), "");
}

TEST(Memory, PhotonsThatNobodyNeedsAreNoReason) {
  MemoryScene scene = box_scene(1, 0);
  add_sky(scene);
  scene.scene.render.photons = 1000000000;
  EXPECT_EQ(complaint(scene.scene, 1 * gigabyte), "");
}

TEST(Memory, HugeImagesAreRefusedOrFit) {
  MemoryScene scene = box_scene(1);
  add_sky(scene);
  scene.scene.image = {16384, 16384};
  EXPECT_EQ(complaint(scene.scene, 16 * gigabyte),
            "scene: image: 16384 x 16384 pixels would take 73.0 GB of the 16.0 GB that this "
            "machine grants: render a smaller image");
  EXPECT_EQ(complaint(scene.scene, 128 * gigabyte), "");
  scene.scene.image = {65536, 65536}; // 2^32 pixels: no 32-bit product
  EXPECT_NE(complaint(scene.scene, 128 * gigabyte), "");
}

TEST(Memory, ThisMachineGrantsSome) {
  EXPECT_GT(granted_memory(), gigabyte / 10);
  EXPECT_LT(granted_memory(), std::uint64_t(1) << 50);
}

TEST(Memory, AJobOfSlurmHasItsShare) {
  setenv("SLURM_MEM_PER_NODE", "64", 1);
  EXPECT_EQ(granted_memory(), std::uint64_t(64) << 20);
  unsetenv("SLURM_MEM_PER_NODE");
}

/// A scene of a small VDB in `folder`.
Scene file_scene(const TempFolder& folder) {
  VolumeOptions options;
  options.size = 8;
  write_volume("sphere", folder.file("ball.vdb"), options);
  MemoryScene scene = box_scene(2);
  scene.scene.volumes[0].file = folder.file("ball.vdb");
  add_sky(scene);
  scene.scene.render.photons = 1000;
  return scene.scene;
}

TEST(Memory, RenderRefusesBeforeItAllocates) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.photons = ~std::uint64_t(0) >> 1;
  EXPECT_THROW(render(scene), InputError);
}

/// Whether a note of the render holds the word.
bool noted(const Scene& scene, const std::string& word) {
  const RenderResult result = render(scene);
  return std::any_of(result.notes.begin(), result.notes.end(),
                     [&](const std::string& note) { return note.find(word) != std::string::npos; });
}

TEST(Limits, KernelWiderThanTheMediumIsNoted) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.passes = 1;
  scene.render.kernel = KernelRadius::fixed;
  scene.render.radius = 0.1;
  EXPECT_FALSE(noted(scene, "render.radius"));
  scene.render.radius = 10;
  EXPECT_TRUE(noted(scene, "render.radius"));
}

TEST(Limits, KernelsThatMeetNoPhotonsAreNoted) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.estimator = EstimatorType::beam;
  scene.render.passes = 1;
  EXPECT_FALSE(noted(scene, "less than one each"));
  scene.render.kernel = KernelRadius::fixed;
  scene.render.radius = 1e-4;
  EXPECT_TRUE(noted(scene, "less than one each"));
}

/// No forward peak is taken out of these: photons have to meet the lobe.
TEST(Limits, NarrowBackwardLobesAreNoted) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.estimator = EstimatorType::beam;
  scene.render.passes = 1;
  scene.volumes[0].phase.type = PhaseType::henyey_greenstein;
  scene.volumes[0].phase.g = -0.9999;
  EXPECT_TRUE(noted(scene, "g = -1 is so narrow"));
}

/// Mean of the picture's red.
double brightness(const Scene& scene) {
  const std::vector<float> values = render(scene).image.find("R")->data;
  double sum = 0;
  for (const float value : values)
    sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

/// Media denser than single precision resolves look like the densest that it does.
TEST(Limits, ExtinctionAndDensityBeyondSinglePrecision) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.estimator = EstimatorType::path;
  scene.render.passes = 2;
  scene.volumes[0].albedo = Rgb(0.5f);
  scene.volumes[0].extinction = 1e8;
  const double expected = brightness(scene);
  EXPECT_GT(expected, 0.05);
  scene.volumes[0].extinction = 1e39;
  EXPECT_NEAR(brightness(scene), expected, 0.1 * expected);
  EXPECT_FALSE(noted(scene, "not finite"));
  scene.volumes[0].extinction = 1;
  scene.volumes[0].remap.scale = 1e308;
  EXPECT_NEAR(brightness(scene), expected, 0.1 * expected);
  EXPECT_FALSE(noted(scene, "not finite"));
}

TEST(Limits, SheetsAreNoted) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.passes = 1;
  EXPECT_FALSE(noted(scene, "sheet"));
  scene.volumes[0].transform[5] = 0.001; // y
  EXPECT_TRUE(noted(scene, "sheet"));
  scene.render.estimator = EstimatorType::path;
  EXPECT_FALSE(noted(scene, "sheet"));
}

TEST(Limits, WhatPhotonsDoNotResolveIsNoted) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.passes = 1;
  scene.image = {1, 1}; // in such depths a ray takes seconds
  EXPECT_FALSE(noted(scene, "mean free paths"));
  scene.volumes[0].extinction = 1e5;
  EXPECT_TRUE(noted(scene, "mean free paths"));
  scene.render.estimator = EstimatorType::path;
  EXPECT_FALSE(noted(scene, "mean free paths"));
  scene.volumes[0].extinction = 1e7;
  EXPECT_TRUE(noted(scene, "mean free paths"));
  scene.render.estimator = EstimatorType::beam;
  scene.volumes[0].extinction = 2;
  scene.volumes[0].phase = henyey_greenstein(0.999);
  EXPECT_FALSE(noted(scene, "narrow")); // the peak is taken out
  scene.render.forward_peak = ForwardPeak::kept;
  EXPECT_TRUE(noted(scene, "narrow"));
}

/// The picture is there, every pixel of it, but it does not count as one.
TEST(Limits, TimeShorterThanOnePass) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.time = 1e-9;
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    scene.render.estimator = type;
    const RenderResult result = render(scene);
    EXPECT_EQ(result.stopped_by, "time");
    EXPECT_EQ(result.passes.size(), 0u);
    EXPECT_TRUE(result.quick_look);
    for (const float value : result.image.find("R")->data)
      EXPECT_GT(value, 0);
  }
}

TEST(Limits, QuickLookBeforeTheFirstPassChangesNothing) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.passes = 2;
  const RenderResult without = render(scene);
  int looks = 0;
  RenderHooks hooks;
  hooks.on_quick_look = [&](RenderResult& look) {
    ++looks;
    EXPECT_TRUE(look.quick_look);
    for (const float value : look.image.find("R")->data)
      EXPECT_GT(value, 0);
  };
  const RenderResult with = render(scene, {}, hooks);
  EXPECT_EQ(looks, 1);
  EXPECT_FALSE(with.quick_look);
  for (std::size_t c = 0; c < without.image.channels.size(); ++c)
    EXPECT_EQ(with.image.channels[c].data, without.image.channels[c].data);
}

/// A pass may not take more work where a density is absurd than where it is merely great: what a
/// damaged file holds. Without a limit the walks stand still between two numbers of single
/// precision.
TEST(Limits, AbsurdDensitiesAreBoundedWork) {
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    test::MemoryScene scene;
    const Vec3<int> cells{4, 4, 4};
    const auto damaged = [](int i, int j, int k) {
      return i == 13 && j == 14 && k == 15 ? 2.7e32 : test::lattice_noise(i, j, k);
    };
    scene.add(test::closed_field(cells, damaged), test::box_map(cells, Vec3d(-1), Vec3d(1)));
    scene.add_light(LightType::distant).direction = {0.3, -0.9, -0.2};
    scene.add_light(LightType::environment).radiance = Rgb(0.1f);
    scene.look({0, 0, 6}, {0, 0, 0}, 24, 16, 16);
    scene.scene.render.photons = 1000;
    const test::PassMeans means = test::render_sound(scene, type, 1, "absurd density");
    EXPECT_GT(means.total[0].mean(), 0);
  }
}

TEST(Limits, OnePass) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.passes = 1;
  const RenderResult result = render(scene);
  EXPECT_EQ(result.stopped_by, "passes");
  EXPECT_EQ(result.passes.size(), 1u);
}

TEST(Limits, HundredThousandPassesOfAConstant) {
  Film film(2, 1);
  PassImage pass;
  pass.resize(2, 1);
  pass.direct = {Rgb(0.1f), Rgb(1e-20f)};
  pass.background = {Rgb(1e6f), Rgb(1e20f)};
  pass.opacity = {0.3f, 1};
  for (int i = 0; i < 100000; ++i)
    film.add(pass);
  const Image image = film.develop();
  EXPECT_NEAR(image.find("volume_direct.R")->data[0], 0.1f, 1e-7f);
  EXPECT_NEAR(image.find("R")->data[0], 1e6f + 0.1f, 1);
  EXPECT_NEAR(image.find("A")->data[0], 0.3f, 3e-7f);
  EXPECT_NEAR(image.find("volume_direct.R")->data[1] / 1e-20f, 1, 1e-6);
  EXPECT_NEAR(image.find("R")->data[1] / 1e20f, 1, 1e-6);
  EXPECT_LT(film.mrse_estimate(), 1e-12);
}

TEST(Limits, RadiusShrinksWithoutVanishing) {
  const TempFolder folder;
  Scene scene = file_scene(folder);
  scene.render.alpha = 1e-6;
  scene.render.passes = 300;
  scene.image = {2, 2};
  const RenderResult result = render(scene);
  for (const float value : result.image.find("R")->data)
    EXPECT_TRUE(std::isfinite(value) && value > 0) << value;
}

/// Light is linear: the same random numbers under a light `scale` times stronger give the same
/// picture, times `scale`, to rounding.
class Radiance : public ::testing::TestWithParam<std::tuple<double, EstimatorType>> {};

TEST_P(Radiance, ScalesThePicture) {
  const auto& [scale, type] = GetParam();
  const auto shine = [](double strength, EstimatorType estimator) {
    MemoryScene scene = box_scene(6, 0.9);
    const float s = static_cast<float>(strength);
    add_sky(scene, s);
    add_sun(scene, {0.3, -1, -0.5}, s);
    LightSettings& lamp = scene.add_light(LightType::point);
    lamp.position = {2, 1, 1};
    lamp.intensity = Rgb(s);
    LightSettings& disc = scene.add_light(LightType::distant);
    disc.direction = {-1, -1, 0};
    disc.angular_radius = 1e-3;
    disc.irradiance = Rgb(s);
    scene.scene.render.photons = 5000;
    return render_sound(scene, estimator, 2, "radiance");
  };
  const PassMeans one = shine(1, type), other = shine(scale, type);
  for (std::size_t i = 0; i < one.pixels.size(); ++i)
    EXPECT_NEAR(static_cast<double>(other.pixels[i].x) / scale,
                static_cast<double>(one.pixels[i].x), 1e-4 * static_cast<double>(one.pixels[i].x));
}

INSTANTIATE_TEST_SUITE_P(Magnitudes, Radiance,
                         ::testing::Combine(::testing::Values(1e-20, 1e-10, 1e10, 1e20),
                                            ::testing::Values(EstimatorType::beam,
                                                              EstimatorType::march,
                                                              EstimatorType::path)),
                         [](const auto& radiance) {
                           const double exponent = std::log10(std::get<0>(radiance.param));
                           return std::string(exponent < 0 ? "Minus" : "Plus") +
                                  std::to_string(static_cast<int>(std::abs(exponent))) + "_" +
                                  name_of(std::get<1>(radiance.param));
                         });

} // namespace
} // namespace vdbeam
