#include "lights/lamps/ies_profile.h"

#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

namespace vdbeam {
namespace {

constexpr double radians = std::numbers::pi / 180;
/// More than any instrument measures.
constexpr std::int64_t most_angles = 10000, most_values = 4 << 20;

/// The lines of a photometric file, and the numbers in those after its head.
class IesText {
public:
  IesText(const std::string& text, const std::string& name) : rest_(text), name_(one_line(name)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
  }
  std::string where() const { return fmt::format("{}:{}", name_, line_); }

  /// The next line without its end, or an error that says what the file lacks.
  std::string_view line(const char* lacks) {
    if (rest_.empty())
      fail(fmt::format("is not a photometric file of LM-63: it ends before {}", lacks));
    const std::size_t end = rest_.find('\n');
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    while (!text.empty() && (text.back() == '\r' || text.back() == ' '))
      text.remove_suffix(1);
    return text;
  }

  /// The next number, wherever the line ends; `what` it is, for messages.
  double number(const char* what) {
    line_ += !started_; // the one after the last of the head
    started_ = true;
    std::size_t begin = 0;
    for (; begin < rest_.size() && is_gap(rest_[begin]); ++begin)
      line_ += rest_[begin] == '\n';
    rest_.remove_prefix(begin);
    std::size_t length = 0;
    while (length < rest_.size() && !is_gap(rest_[length]))
      ++length;
    if (length == 0)
      fail(fmt::format("ends where {} should be", what));
    const std::string_view word = rest_.substr(0, length);
    const bool plus = word.front() == '+';
    double x = 0;
    const auto [end, error] = std::from_chars(word.data() + plus, word.data() + length, x);
    if (error != std::errc() || end != word.data() + length || !std::isfinite(x))
      fail(fmt::format("{} must be a number, got \"{}\"", what,
                       one_line(std::string(word.substr(0, 40)))));
    rest_.remove_prefix(length);
    return x;
  }
  std::int64_t count(const char* what) {
    const double x = number(what);
    if (!(x >= 1 && x <= static_cast<double>(most_angles)) || x != std::floor(x))
      fail(fmt::format("{} must be a whole number from 1 to {}, got {}", what, most_angles, x));
    return static_cast<std::int64_t>(x);
  }
  double factor(const char* what) {
    const double x = number(what);
    if (!(x > 0))
      fail(fmt::format("{} must be greater than 0, got {}", what, x));
    return x;
  }
  /// Ascending numbers from 0 to `most`.
  std::vector<double> angles(std::int64_t count, double most, const char* what) {
    std::vector<double> list;
    for (std::int64_t i = 0; i < count; ++i) {
      list.push_back(number(what));
      if (list.back() < 0 || list.back() > most)
        fail(fmt::format("{} must lie in [0, {}], got {}", what, most, list.back()));
      if (i > 0 && !(list[list.size() - 2] < list.back()))
        fail(fmt::format("{} must ascend, got {} after {}", what, list.back(),
                         list[list.size() - 2]));
    }
    return list;
  }

private:
  static bool is_gap(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; }

  std::string_view rest_;
  std::string name_;
  int line_ = 0;
  bool started_ = false;
};

/// Reads up to TILT= and what belongs to it, by which the output of some lamps depends on how they
/// are mounted; the profile is used as measured.
void skip_head(IesText& text) {
  std::string_view tilt;
  do
    tilt = text.line("a line TILT=NONE");
  while (!tilt.starts_with("TILT="));
  if (tilt != "TILT=INCLUDE")
    return;
  text.number("the lamp's mounting");
  const std::int64_t pairs = text.count("the number of tilt angles");
  for (std::int64_t i = 0; i < 2 * pairs; ++i)
    text.number("a tilt angle or its factor");
}

} // namespace

IesProfile::IesProfile(const std::string& content, const std::string& name) {
  IesText text(content, name);
  skip_head(text);
  text.number("the number of lamps");
  text.number("lumens per lamp");
  double scale = text.factor("the multiplier of candela");
  const std::int64_t verticals = text.count("the number of vertical angles");
  const std::int64_t horizontals = text.count("the number of horizontal angles");
  if (verticals < 2)
    text.fail("there must be at least 2 vertical angles, got 1");
  if (verticals * horizontals > most_values)
    text.fail(fmt::format("has {} x {} intensities; there may be {}", verticals, horizontals,
                          most_values));
  if (const double type = text.number("the photometric type"); type != 1)
    text.fail(fmt::format("the photometric type must be 1 (C), got {}{}", type,
                          type == 2   ? " (B): convert the file to type C"
                          : type == 3 ? " (A): convert the file to type C"
                                      : ""));
  text.number("the units of the size");
  for (const char* what : {"the width", "the length", "the height"})
    text.number(what);
  scale *= text.factor("the ballast factor");
  text.number("the factor after the ballast factor");
  text.number("the input watts");
  vertical_ = text.angles(verticals, 180, "a vertical angle");
  horizontal_ = text.angles(horizontals, 360, "a horizontal angle");
  const std::string where = text.where();
  values_.reserve(static_cast<std::size_t>(verticals * horizontals));
  for (std::int64_t i = 0; i < verticals * horizontals; ++i) {
    values_.push_back(text.number("an intensity"));
    if (values_.back() < 0)
      text.fail(fmt::format("an intensity must be at least 0, got {}", values_.back()));
  }
  const double most = *std::max_element(values_.begin(), values_.end());
  if (!(most > 0))
    text.fail("all intensities are 0: the lamp is dark");
  for (double& value : values_)
    value /= most;
  candela_ = most * scale;
  close_planes(where);
  integral_ = integrate();
}

void IesProfile::close_planes(const std::string& where) {
  const double first = horizontal_.front(), last = horizontal_.back();
  if (horizontal_.size() == 1)
    return;
  if (first == 0 && last > 180 &&
      last < 360) { // LM-63 asks for the plane of 360 degrees; many lack it
    horizontal_.push_back(360);
    const std::vector<double> again(
        values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(vertical_.size()));
    values_.insert(values_.end(), again.begin(), again.end());
  } else if (!(first == 0 && (last == 90 || last == 180 || last == 360)) &&
             !(first == 90 && last == 270)) {
    throw InputError(
        fmt::format("{}: the horizontal angles must go from 0 to 90, 180 or 360, or from "
                    "90 to 270, got {} to {}",
                    where, first, last));
  }
}

double IesProfile::folded(double horizontal) const {
  const double last = horizontal_.back();
  if (last == 360)
    return horizontal;
  if (horizontal_.front() == 90) // mirrored at the plane of 90 and 270 degrees
    return horizontal < 90 ? 180 - horizontal : horizontal > 270 ? 540 - horizontal : horizontal;
  const double half = horizontal > 180 ? 360 - horizontal : horizontal;
  return last == 90 && half > 90 ? 180 - half : half;
}

double IesProfile::at(double vertical, double horizontal) const {
  if (!(vertical >= vertical_.front() && vertical <= vertical_.back()))
    return 0;
  const auto place = [](const std::vector<double>& list, double x, double& rest) {
    const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - list.begin()) - 1;
    rest = std::clamp((x - list[i]) / (list[i + 1] - list[i]), 0.0, 1.0);
    return i;
  };
  double v = 0, h = 0;
  const std::size_t j = place(vertical_, vertical, v);
  const auto along = [&](std::size_t plane) {
    return value(plane, j) + v * (value(plane, j + 1) - value(plane, j));
  };
  if (is_round())
    return along(0);
  const std::size_t i = place(horizontal_, folded(horizontal), h);
  const double before = along(i);
  return before + h * (along(i + 1) - before);
}

/// Over the vertical angle t, with sin t: between two angles a and b, with slope s,
/// I(a) cos a - I(b) cos b + s (sin b - sin a).
double IesProfile::plane_integral(std::size_t horizontal) const {
  double sum = 0;
  for (std::size_t j = 0; j + 1 < vertical_.size(); ++j) {
    const double a = vertical_[j] * radians, b = vertical_[j + 1] * radians;
    const double at_a = value(horizontal, j), at_b = value(horizontal, j + 1);
    sum += at_a * std::cos(a) - at_b * std::cos(b) +
           (at_b - at_a) / (b - a) * (std::sin(b) - std::sin(a));
  }
  return sum;
}

double IesProfile::integrate() const {
  if (is_round())
    return 2 * std::numbers::pi * plane_integral(0);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < horizontal_.size(); ++i)
    sum += (horizontal_[i + 1] - horizontal_[i]) * radians / 2 *
           (plane_integral(i) + plane_integral(i + 1));
  return sum * 360 / (horizontal_.back() - horizontal_.front());
}

IesProfile read_ies_profile(const std::string& path) {
  constexpr std::uint64_t most_bytes = 16 << 20;
  return {read_text(path, most_bytes), path};
}

} // namespace vdbeam
