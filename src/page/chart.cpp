#include "page/chart.h"

#include "page/html_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace vdbeam {
namespace {

// In units of the drawing, which pages show at 0.9 to 1.5 pixels each: 12 stays readable.
constexpr double width = 400, height = 232;
constexpr double left = 60, right = 390, top = 14, bottom = 186;
constexpr int most_ticks = 6;
constexpr double logarithmic_from = 30; ///< ratio of the largest value to the smallest

/// The least of 1, 2 and 5 times a power of ten that is at least `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= step * (1 - 1e-9))
      return factor * power;
  return 10 * power;
}

std::vector<double> decades(double low, double high) {
  std::vector<double> ticks;
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
  const int step = std::max(1, (last - first) / most_ticks);
  for (int exponent = first; exponent <= last; exponent += step)
    ticks.push_back(std::pow(10.0, exponent));
  return ticks;
}

/// 10^this is taken out of the numbers of the axis and stands in its label: 0 where they are short.
int axis_exponent(const ChartAxis& axis) {
  constexpr double shortest = 0.01, longest = 1e5;
  if (axis.logarithmic || (axis.high >= shortest && axis.high < longest))
    return 0;
  return static_cast<int>(std::floor(std::log10(axis.high)));
}

std::string tick_text(const ChartAxis& axis, double tick) {
  if (axis.logarithmic) // powers of ten
    return fmt::format("1e{}", static_cast<int>(std::lround(std::log10(tick))));
  return number_text(tick / std::pow(10.0, axis_exponent(axis)));
}

std::string unit_text(const Chart& chart, const ChartAxis& axis) {
  const int exponent = axis_exponent(axis);
  return exponent == 0 ? chart.unit : fmt::format("{} (1e{})", chart.unit, exponent);
}

/// Whole numbers from the first frame to the last.
std::vector<int> frame_ticks(int first, int last) {
  const double range = static_cast<double>(last) - first;
  const auto step = static_cast<int>(std::max(1.0, round_step(std::max(1.0, range) / most_ticks)));
  std::vector<int> ticks;
  for (std::int64_t tick = first - ((first % step) + step) % step; tick <= last; tick += step)
    if (tick >= first)
      ticks.push_back(static_cast<int>(tick));
  return ticks;
}

/// The horizontal axis.
struct Frames {
  int first = 1, last = 1;

  explicit Frames(const Chart& chart) {
    std::vector<int> all = chart.lost;
    for (const ChartPoint& point : chart.points)
      all.push_back(point.frame);
    if (all.empty())
      return;
    first = *std::min_element(all.begin(), all.end());
    last = *std::max_element(all.begin(), all.end());
  }
  double column() const { return (right - left) / (static_cast<double>(last) - first + 1); }
  double x(int frame) const { return left + (static_cast<double>(frame) - first + 0.5) * column(); }
};

double y_of(const ChartAxis& axis, double value) {
  return bottom - axis.place(value) * (bottom - top);
}

std::string axes(const Chart& chart, const ChartAxis& axis, const Frames& frames) {
  std::string svg;
  for (const double tick : axis.ticks) {
    const double y = y_of(axis, tick);
    svg += fmt::format(R"(<line class="grid" x1="{}" y1="{:.1f}" x2="{}" y2="{:.1f}"/>)", left, y,
                       right, y);
    svg += fmt::format(R"(<text x="{}" y="{:.1f}" text-anchor="end">{}</text>)", left - 6, y + 4,
                       tick_text(axis, tick));
  }
  for (const int tick : frame_ticks(frames.first, frames.last))
    svg += fmt::format(R"(<text x="{:.1f}" y="{}" text-anchor="middle">{}</text>)", frames.x(tick),
                       bottom + 18, tick);
  svg += fmt::format(R"(<line class="axis" x1="{0}" y1="{1}" x2="{2}" y2="{1}"/>)", left, bottom,
                     right);
  svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">frame</text>)", (left + right) / 2,
                     height - 8);
  svg += fmt::format(
      R"svg(<text transform="rotate(-90)" x="{}" y="12" text-anchor="middle">{}</text>)svg",
      -(top + bottom) / 2, html_text(unit_text(chart, axis)));
  return svg;
}

/// Lines between frames that follow each other; one that failed leaves a gap.
std::string line(const Chart& chart, const ChartAxis& axis, const Frames& frames) {
  std::string path;
  const ChartPoint* before = nullptr;
  for (const ChartPoint& point : chart.points) {
    const bool gap = !before || std::any_of(chart.lost.begin(), chart.lost.end(), [&](int frame) {
      return frame > before->frame && frame < point.frame;
    });
    path += fmt::format("{}{:.1f} {:.1f}", gap ? 'M' : 'L', frames.x(point.frame),
                        y_of(axis, point.value));
    before = &point;
  }
  return path.empty() ? "" : fmt::format(R"(<path class="line" d="{}"/>)", path);
}

std::string mark(const ChartPoint& point, const ChartAxis& axis, const Frames& frames) {
  const double x = frames.x(point.frame);
  const double radius = std::clamp(0.3 * frames.column(), 0.8, 3.0);
  std::string svg = fmt::format("<g><title>{}</title>", html_text(point.label));
  // The whole column answers the pointer.
  svg += fmt::format(R"(<rect class="hit" x="{:.2f}" y="{}" width="{:.2f}" height="{}"/>)",
                     x - frames.column() / 2, top, frames.column(), bottom - top);
  if (point.low && point.high)
    svg += fmt::format(
        R"(<line class="interval" x1="{0:.2f}" y1="{1:.1f}" x2="{0:.2f}" y2="{2:.1f}"/>)", x,
        y_of(axis, *point.low), y_of(axis, *point.high));
  return svg + fmt::format(R"(<circle class="dot" cx="{:.2f}" cy="{:.1f}" r="{:.1f}"/></g>)", x,
                           y_of(axis, point.value), radius);
}

std::string cross(int frame, const Frames& frames) {
  constexpr double arm = 4;
  const double x = frames.x(frame);
  return fmt::format(
      R"(<g><title>frame {}: failed</title><path class="lost" d="M{:.1f} {:.1f}l{} {}m0 {}l{} {}"/></g>)",
      frame, x - arm, bottom - arm - 2, 2 * arm, 2 * arm, -2 * arm, -2 * arm, 2 * arm);
}

} // namespace

double ChartAxis::place(double value) const {
  const double part = logarithmic ? std::log(std::max(value, low) / low) / std::log(high / low)
                                  : (value - low) / (high - low);
  return std::clamp(part, 0.0, 1.0);
}

ChartAxis value_axis(const std::vector<ChartPoint>& points) {
  double least = INFINITY, most = 0;
  for (const ChartPoint& point : points) {
    least = std::min(least, point.value);
    most = std::max({most, point.value, point.high.value_or(0)});
  }
  ChartAxis axis;
  if (!(most > 0) || !std::isfinite(most)) {
    axis.ticks = {0, 1};
    return axis;
  }
  axis.logarithmic = least > 0 && most > logarithmic_from * least;
  if (axis.logarithmic) {
    axis.ticks = decades(least, most);
    axis.low = axis.ticks.front();
    axis.high = std::max(most, axis.ticks.back());
    return axis;
  }
  const double step = round_step(most / (most_ticks - 1));
  const double count = std::ceil(most / step - 1e-9);
  for (int i = 0; i <= static_cast<int>(count); ++i)
    axis.ticks.push_back(i * step);
  axis.high = axis.ticks.back();
  return axis;
}

std::string chart_svg(const Chart& chart) {
  const Frames frames(chart);
  const ChartAxis axis = value_axis(chart.points);
  std::string svg = fmt::format(R"(<svg viewBox="0 0 {} {}" role="img" aria-label="{}">)", width,
                                height, html_text(chart.title));
  svg += axes(chart, axis, frames);
  if (chart.points.empty())
    svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">no values</text>)",
                       (left + right) / 2, (top + bottom) / 2);
  svg += line(chart, axis, frames);
  for (const ChartPoint& point : chart.points)
    svg += mark(point, axis, frames);
  for (const int frame : chart.lost)
    svg += cross(frame, frames);
  return svg + "</svg>";
}

} // namespace vdbeam
