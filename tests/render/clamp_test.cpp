#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vdbeam {
namespace {

constexpr int passes = 4;

Scene cloud_by_path(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=24", "image.height=14", "render.estimator=path",
                                     "render.passes=4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1, overrides);
}

/// Sum over pixels of R, G and B.
double light_of(const Image& image) {
  double sum = 0;
  for (const char* channel : {"R", "G", "B"})
    for (const float value : image.find(channel)->data)
      sum += static_cast<double>(value);
  return sum;
}

bool notes_clamp(const RenderResult& result) {
  return std::any_of(result.notes.begin(), result.notes.end(), [](const std::string& note) {
    return note.find("render.clamp") != std::string::npos;
  });
}

TEST(Clamp, IsOffUnlessAskedFor) {
  const RenderResult result = render(cloud_by_path());
  EXPECT_EQ(result.statistics.clamp_total, 0);
  EXPECT_FALSE(notes_clamp(result));
}

/// The picture lacks just the energy that the report names.
TEST(Clamp, WhatItTookIsTold) {
  const RenderResult whole = render(cloud_by_path());
  const RenderResult clamped = render(cloud_by_path({"render.clamp=0.5"}));
  const RenderStatistics& statistics = clamped.statistics;
  EXPECT_GT(statistics.clamped_pixels, 0u);
  EXPECT_GT(statistics.clamped_fraction(), 0.001);
  EXPECT_NEAR(statistics.clamp_total / passes, light_of(whole.image), 1e-5 * light_of(whole.image));
  EXPECT_NEAR(light_of(whole.image) - light_of(clamped.image), statistics.clamp_removed / passes,
              1e-5 * light_of(whole.image));
  EXPECT_TRUE(notes_clamp(clamped));
}

TEST(Clamp, ALimitThatNothingReachesTakesNothing) {
  const RenderResult whole = render(cloud_by_path());
  const RenderResult clamped = render(cloud_by_path({"render.clamp=1e30"}));
  EXPECT_EQ(clamped.statistics.clamp_removed, 0);
  EXPECT_EQ(light_of(clamped.image), light_of(whole.image));
  EXPECT_TRUE(notes_clamp(clamped)) << "that it took nothing is worth a line";
}

/// Parts and resumed renders report the sum.
TEST(Clamp, TalliesOfPartsAddUp) {
  const test::TempFolder folder;
  const Scene scene = cloud_by_path({"render.clamp=0.5"});
  const RenderStatistics whole = render(scene).statistics;
  const auto parts = test::render_parts(scene, folder, {{0, 1}, {2, 3}});
  const Image merged = merge_partials(parts);
  EXPECT_NEAR(merged.numbers.at("vdbeam:clampRemoved"), whole.clamp_removed,
              1e-6 * whole.clamp_removed);
  EXPECT_NEAR(merged.numbers.at("vdbeam:clampTotal"), whole.clamp_total, 1e-6 * whole.clamp_total);
  EXPECT_EQ(merged.numbers.at("vdbeam:clampedPixels"), static_cast<double>(whole.clamped_pixels));

  FrameSettings frame; // the first two passes as a checkpoint
  frame.checkpoint.path = parts[0];
  const RenderResult resumed = render(scene, frame);
  EXPECT_EQ(resumed.resumed_passes, 2);
  EXPECT_NEAR(resumed.statistics.clamp_removed, whole.clamp_removed, 1e-6 * whole.clamp_removed);
  EXPECT_EQ(resumed.statistics.clamped_pixels, whole.clamped_pixels);
}

} // namespace
} // namespace vdbeam
