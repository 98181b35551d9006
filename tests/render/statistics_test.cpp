#include "vdbeam/render_statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

TEST(RenderStatistics, AddUp) {
  RenderStatistics sum, pass;
  pass.query = 0.5;
  pass.light_paths = 100;
  pass.importance_rays = 7;
  pass.clamp_total = 2;
  pass.peak_memory = 1000;
  pass.neighbours = 850;
  sum += pass;
  pass.peak_memory = 900;
  sum += pass;
  EXPECT_EQ(sum.query, 1);
  EXPECT_EQ(sum.light_paths, 200u);
  EXPECT_EQ(sum.importance_rays, 14u);
  EXPECT_EQ(sum.clamp_total, 4);
  EXPECT_EQ(sum.peak_memory, 1000u);
  EXPECT_EQ(sum.neighbours, 850);
}

} // namespace
} // namespace vdbeam
