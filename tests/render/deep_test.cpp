#include "support/image_checks.h"
#include "support/read_deep.h"
#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <ImfCheckFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace vdbeam {
namespace {

using test::plane;

Scene sample_scene(const std::string& file, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=24", "image.height=16", "render.photons=3000",
                                     "render.passes=4", "image.deep=true"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/" + file, 14, overrides);
}

struct FlatCase {
  const char* name;
  const char* file;
  std::vector<std::string> overrides;
};

class Flattened : public testing::TestWithParam<FlatCase> {};

/// Samples laid over each other are the layer `volume`, but for rounding: whatever finds the light,
/// whatever the camera and the moments.
TEST_P(Flattened, IsTheFlatPicture) {
  const RenderResult result = render(sample_scene(GetParam().file, GetParam().overrides));
  ASSERT_TRUE(result.deep);
  const auto flat = result.deep->flatten();
  const char* channels[] = {"volume.R", "volume.G", "volume.B", "volume.A"};
  for (std::size_t c = 0; c < 4; ++c) {
    const std::vector<float>& expected = plane(result.image, channels[c]);
    ASSERT_EQ(flat.size(), expected.size());
    double sum = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      ASSERT_NEAR(flat[i][c], expected[i], 2e-4 * std::abs(expected[i]) + 2e-6)
          << channels[c] << " of pixel " << i;
      sum += static_cast<double>(expected[i]);
    }
    if (c < 3) {
      EXPECT_GT(sum, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Deep, Flattened,
    testing::Values(FlatCase{"Path", "sunlit_cloud.toml", {"render.estimator=path"}},
                    FlatCase{"Beam", "sunlit_cloud.toml", {"render.estimator=beam"}},
                    FlatCase{"BeamWithPeaks",
                             "sunlit_cloud.toml",
                             {"render.estimator=beam", "render.forward_peak=kept"}},
                    FlatCase{"BeamByPhotons",
                             "sunlit_cloud.toml",
                             {"render.estimator=beam", "render.direct=photons"}},
                    FlatCase{"FinalGathering", "sunlit_cloud.toml", {"render.estimator=gather"}},
                    FlatCase{"FireByFinalGathering", "fire.toml", {"render.estimator=gather"}},
                    FlatCase{"March", "sunlit_cloud.toml", {"render.estimator=march"}},
                    FlatCase{"GroupsOfLights", "sunlit_cloud.toml", {"light.0.group=sun"}},
                    FlatCase{"Lens",
                             "sunlit_cloud.toml",
                             {"camera.lens_radius=0.3", "camera.focus_distance=5"}},
                    FlatCase{"Parallel",
                             "sunlit_cloud.toml",
                             {"camera.projection=orthographic", "camera.view_height=2"}},
                    FlatCase{"ColouredExtinction",
                             "sunlit_cloud.toml",
                             {"volume.0.extinction_scale=[1, 0.6, 0.3]", "render.estimator=path"}},
                    FlatCase{"Fire", "fire.toml", {"render.estimator=beam"}},
                    FlatCase{"FireWithoutSmoke", "fire.toml", {"volume.0.extinction=0"}},
                    FlatCase{"FireByPaths", "fire.toml", {"render.estimator=path"}},
                    FlatCase{"Overscan", "sunlit_cloud.toml", {"image.overscan=3"}},
                    FlatCase{"Air",
                             "sunlit_cloud.toml",
                             {"light.2.type=atmosphere", "light.2.metres_per_unit=4000",
                              "light.2.altitude=9000", "light.2.group=sky"}},
                    FlatCase{"AirByPaths",
                             "fire.toml",
                             {"light.2.type=atmosphere", "light.2.metres_per_unit=4000",
                              "light.2.altitude=9000", "render.estimator=path"}}),
    [](const auto& test) { return test.param.name; });

/// What lies before a plane; samples that it cuts give their homogeneous share, as OpenEXR
/// defines it (Interpreting OpenEXR Deep Pixels, "Splitting a volume sample").
std::vector<std::array<float, 4>> flatten_before(const DeepImage& deep, float plane_z) {
  DeepImage front = deep;
  std::size_t sample = 0;
  for (const std::uint32_t count : deep.counts)
    for (const std::size_t end = sample + count; sample < end; ++sample) {
      const double z0 = static_cast<double>(deep.z[sample]),
                   z1 = static_cast<double>(deep.z_back[sample]);
      const double share = std::clamp((static_cast<double>(plane_z) - z0) / (z1 - z0), 0.0, 1.0);
      const double a = static_cast<double>(deep.a[sample]);
      const double cut = a < 1 ? -std::expm1(share * std::log1p(-a)) : (share > 0 ? 1 : 0);
      const auto factor = static_cast<float>(a > 1e-7 ? cut / a : share);
      front.a[sample] = static_cast<float>(cut);
      for (std::vector<float>* colour : {&front.r, &front.g, &front.b})
        (*colour)[sample] *= factor;
    }
  return front.flatten();
}

class CutByAPlane : public testing::TestWithParam<const char*> {};

/// An opaque black object behind which nothing is seen is the far plane of the camera: over it lies
/// what of the deep picture is nearer, in light and opacity, all over the picture and in its parts.
TEST_P(CutByAPlane, SlowIsAPictureWithAFarPlane) {
  const std::vector<std::string> common{std::string("render.estimator=") + GetParam(),
                                        std::string("render.passes=") +
                                            (GetParam() == std::string("path") ? "128" : "32"),
                                        "render.forward_peak=kept",
                                        "render.photons=40000",
                                        "image.deep_alpha=0.02",
                                        "volume.0.extinction=12"};
  const RenderResult deep = render(sample_scene("sunlit_cloud.toml", common));
  for (const float plane_z : {6.3f, 6.6f}) {
    std::vector<std::string> cut = common;
    cut.push_back("camera.far=" + std::to_string(plane_z));
    const Image expected = render(sample_scene("sunlit_cloud.toml", cut)).image;
    const auto front = flatten_before(*deep.deep, plane_z);
    const char* channels[] = {"volume.R", "volume.G", "volume.B", "volume.A"};
    for (std::size_t c = 0; c < 4; ++c) {
      const std::vector<float>& truth = plane(expected, channels[c]);
      const std::vector<float>& whole = plane(deep.image, channels[c]);
      double sum = 0, expected_sum = 0, whole_sum = 0, squares = 0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        sum += static_cast<double>(front[i][c]);
        expected_sum += static_cast<double>(truth[i]);
        whole_sum += static_cast<double>(whole[i]);
        squares += std::pow(static_cast<double>(front[i][c] - truth[i]), 2);
      }
      const auto pixels = static_cast<double>(truth.size());
      // Both have noise, and kernels blur light across the plane.
      EXPECT_NEAR(sum, expected_sum, 0.03 * expected_sum) << channels[c] << " before " << plane_z;
      EXPECT_LT(std::sqrt(squares / pixels), 0.2 * expected_sum / pixels) << channels[c];
      EXPECT_LT(expected_sum, 0.9 * whole_sum) << "the plane cuts nothing off";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Deep, CutByAPlane, testing::Values("path", "beam", "march"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Deep, SamplesAreInOrderAndNoLongerThanAskedFor) {
  const RenderResult result =
      render(sample_scene("sunlit_cloud.toml", {"image.deep_depth=0.05", "image.deep_alpha=0.1"}));
  const DeepImage& deep = *result.deep;
  std::size_t sample = 0;
  double opacity = 0, opacity_of_long = 0;
  for (const std::uint32_t count : deep.counts)
    for (std::size_t i = 0; i < count; ++i, ++sample) {
      EXPECT_LT(deep.z[sample], deep.z_back[sample]);
      if (i > 0) {
        EXPECT_GE(deep.z[sample], deep.z_back[sample - 1]);
      }
      const auto alpha = static_cast<double>(deep.a[sample]);
      opacity += alpha;
      opacity_of_long += deep.z_back[sample] - deep.z[sample] > 0.05f + 1e-5f ? alpha : 0;
      EXPECT_GE(deep.a[sample], 0);
      EXPECT_LE(deep.a[sample], 1);
    }
  EXPECT_EQ(sample, deep.z.size());
  // Where the rays that make the layout met nothing, and that of a pass does.
  EXPECT_LT(opacity_of_long, 0.03 * opacity);
  EXPECT_GT(deep.alpha_error, 0);
  EXPECT_LT(deep.alpha_error, 0.1f);
}

/// Twice the tolerance takes fewer samples and is less exact.
TEST(Deep, ToleranceTradesSizeForError) {
  const auto with = [](const char* alpha) {
    return *render(sample_scene("sunlit_cloud.toml", {std::string("image.deep_alpha=") + alpha,
                                                      "image.deep_depth=10", "render.passes=1"}))
                .deep;
  };
  const DeepImage fine = with("0.02"), coarse = with("0.2");
  EXPECT_GT(fine.z.size(), 4 * coarse.z.size());
  EXPECT_LT(fine.alpha_error, 0.5f * coarse.alpha_error);
}

TEST(Deep, FlatPictureDoesNotDependOnIt) {
  for (const char* estimator : {"path", "beam", "march"}) {
    const std::string by = std::string("render.estimator=") + estimator;
    const Image with = render(sample_scene("sunlit_cloud.toml", {by})).image;
    const Image without = render(sample_scene("sunlit_cloud.toml", {by, "image.deep=false"})).image;
    for (const char* name : {"R", "volume_indirect.G", "A", "depth.Z"})
      EXPECT_EQ(plane(with, name), plane(without, name)) << estimator;
  }
}

/// In fog that nothing shines through, all but the first samples vanish, and none is not finite.
TEST(Deep, OpaqueCloud) {
  const RenderResult result =
      render(sample_scene("sunlit_cloud.toml", {"volume.0.extinction=1e7", "render.passes=2"}));
  const DeepImage& deep = *result.deep;
  ASSERT_FALSE(deep.z.empty());
  for (const std::vector<float>* values :
       {&deep.r, &deep.g, &deep.b, &deep.a, &deep.z, &deep.z_back})
    for (const float value : *values)
      ASSERT_TRUE(std::isfinite(value));
  const auto flat = deep.flatten();
  for (std::size_t i = 0; i < flat.size(); ++i)
    EXPECT_NEAR(flat[i][3], plane(result.image, "A")[i], 1e-4);
}

class DeepFiles : public testing::Test {
protected:
  test::TempFolder folder_;
};

TEST_F(DeepFiles, HoldWhatWasWrittenAndPassOpenEXRsCheck) {
  const RenderResult result = render(sample_scene("sunlit_cloud.toml", {"image.overscan=2"}));
  const std::string path = folder_.file("deep.exr");
  EXPECT_GT(write_deep_exr(*result.deep, result.image, path), 1000u);
  EXPECT_FALSE(Imf::checkOpenEXRFile(path.c_str()));
  DeepImage expected = *result.deep;
  for (std::vector<float>* colour : {&expected.r, &expected.g, &expected.b})
    for (float& value : *colour)
      value = static_cast<float>(half(value));
  test::expect_same_deep(test::read_deep(path), expected);
}

TEST_F(DeepFiles, PartialRendersMergeToTheUndividedOne) {
  for (const char* region : {"", "5,3,17,11"}) {
    const Scene scene = sample_scene("sunlit_cloud.toml");
    FrameSettings frame;
    if (*region)
      frame.region = PixelRegion{5, 3, 17, 11};
    const RenderResult whole = render(scene, frame);
    const std::string direct = folder_.file("direct.exr");
    write_deep_exr(*whole.deep, whole.image, direct);
    MergeSettings settings;
    settings.deep = folder_.file("merged.exr");
    merge_partials(test::render_parts(scene, folder_, {{0, 0}, {1, 3}}, frame), settings);
    test::expect_same_deep(test::read_deep(settings.deep), test::read_deep(direct));
  }
}

TEST_F(DeepFiles, CheckpointsGoOn) {
  const Scene scene = sample_scene("sunlit_cloud.toml");
  const DeepImage whole = *render(scene).deep;
  FrameSettings frame;
  frame.checkpoint.path = folder_.file("c.exr");
  frame.checkpoint.passes = 2;
  std::atomic<bool> stop{false};
  RenderHooks hooks;
  hooks.stop = &stop;
  hooks.on_pass = [&](const PassRecord& record, const RenderStatistics&) {
    stop = record.pass >= 3;
  };
  render(scene, frame, hooks);
  stop = false;
  hooks.on_pass = {};
  const RenderResult resumed = render(scene, frame, hooks);
  EXPECT_EQ(resumed.resumed_passes, 3);
  test::expect_same_deep(*resumed.deep, whole);
}

TEST(Deep, NamesTheMistake) {
  try {
    sample_scene("sunlit_cloud.toml", {"render.clamp=3"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("image.deep excludes render.clamp"), std::string::npos)
        << error.what();
  }
}

} // namespace
} // namespace vdbeam
