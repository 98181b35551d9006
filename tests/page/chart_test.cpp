#include "page/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

std::vector<ChartPoint> values(const std::vector<double>& list) {
  std::vector<ChartPoint> points;
  for (const double value : list)
    points.push_back({static_cast<int>(points.size()) + 1, value});
  return points;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST(ChartAxis, IsLinearFromZeroForSimilarValues) {
  const ChartAxis axis = value_axis(values({3, 8, 7}));
  EXPECT_FALSE(axis.logarithmic);
  EXPECT_EQ(axis.low, 0);
  EXPECT_EQ(axis.high, 8);
  EXPECT_EQ(axis.ticks, (std::vector<double>{0, 2, 4, 6, 8}));
  EXPECT_EQ(axis.place(4), 0.5);
  EXPECT_EQ(axis.place(100), 1);
}

TEST(ChartAxis, CoversIntervals) {
  auto points = values({1, 2});
  points[1].high = 9;
  EXPECT_EQ(value_axis(points).high, 10);
}

TEST(ChartAxis, IsLogarithmicForValuesOfSeveralDecades) {
  const ChartAxis axis = value_axis(values({2e-5, 0.03}));
  EXPECT_TRUE(axis.logarithmic);
  ASSERT_EQ(axis.ticks.size(), 5U); // 1e-5 to 1e-1
  EXPECT_NEAR(axis.ticks.front(), 1e-5, 1e-12);
  EXPECT_NEAR(axis.place(1e-3), 0.5, 1e-9);
  EXPECT_EQ(axis.place(0), 0); // the low end of an interval
}

TEST(ChartAxis, HoldsWithoutUsableValues) {
  for (const auto& list : std::vector<std::vector<double>>{
           {}, {0}, {0, 0}, {std::numeric_limits<double>::infinity()}}) {
    const ChartAxis axis = value_axis(values(list));
    EXPECT_EQ(axis.low, 0);
    EXPECT_EQ(axis.high, 1);
  }
}

TEST(Chart, ShowsEveryPointWithItsLabel) {
  Chart chart{"Error", "MRSE", values({1, 2, 3}), {}};
  chart.points[1].label = "frame 2: <2>";
  chart.points[1].low = 1.5;
  chart.points[1].high = 2.5;
  const std::string svg = chart_svg(chart);
  EXPECT_EQ(count(svg, "<circle"), 3U);
  EXPECT_EQ(count(svg, "class=\"interval\""), 1U);
  EXPECT_NE(svg.find("<title>frame 2: &lt;2&gt;</title>"), svg.npos);
  EXPECT_NE(svg.find(">MRSE</text>"), svg.npos);
  EXPECT_NE(svg.find(">frame</text>"), svg.npos);
  EXPECT_EQ(svg.find("nan"), svg.npos);
}

TEST(Chart, KeepsTheNumbersOfItsAxisShort) {
  const std::string svg = chart_svg({"Error", "MRSE", values({2e-4, 2.5e-4}), {}});
  EXPECT_NE(svg.find(">MRSE (1e-4)</text>"), svg.npos);
  EXPECT_NE(svg.find(">2.5</text>"), svg.npos);
  EXPECT_EQ(svg.find(">0.0002</text>"), svg.npos);
  EXPECT_NE(chart_svg({"Error", "MRSE", values({1e-5, 1}), {}}).find(">1e-5</text>"), svg.npos);
}

TEST(Chart, LeavesAGapAtAFailedFrame) {
  Chart chart{"Error", "MRSE", {{1, 1}, {2, 1}, {4, 1}, {5, 1}}, {3}};
  const std::string svg = chart_svg(chart);
  const std::string path = svg.substr(svg.find("class=\"line\""));
  EXPECT_EQ(count(path.substr(0, path.find("/>")), "M"), 2U);
  EXPECT_EQ(count(svg, "frame 3: failed"), 1U);
}

TEST(Chart, TakesAnyFrameNumbers) {
  for (const auto& [first, last] : std::vector<std::pair<int, int>>{
           {-5, -5}, {-7, 3}, {0, 100000}, {-2000000000, 2000000000}}) {
    const std::string svg = chart_svg({"Error", "MRSE", {{first, 1}, {last, 2}}, {}});
    EXPECT_EQ(svg.find("nan"), svg.npos);
    EXPECT_EQ(svg.find("inf"), svg.npos);
    EXPECT_LE(count(svg, "<text"), 20U);
  }
}

} // namespace
} // namespace vdbeam
