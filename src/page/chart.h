#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// A value of one frame, with its interval where it has one.
struct ChartPoint {
  int frame = 0;
  double value = 0;
  std::optional<double> low{}, high{};
  std::string label{}; ///< shown while the pointer is over the point
};

/// One quantity over the frames of a batch.
struct Chart {
  std::string title;
  std::string unit; ///< label of the vertical axis
  std::vector<ChartPoint> points;
  std::vector<int> lost; ///< frames that failed: crosses at the foot of the chart
};

/// The vertical axis of a chart: linear from 0, or logarithmic where all values are positive and
/// the largest is more than 30 times the smallest.
struct ChartAxis {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<double> ticks;

  /// The place of a value between `low` (0) and `high` (1), limited to them.
  double place(double value) const;
};

ChartAxis value_axis(const std::vector<ChartPoint>& points);

/// An SVG element with labelled axes; its colours are those of the page's style sheet.
std::string chart_svg(const Chart& chart);

} // namespace vdbeam
