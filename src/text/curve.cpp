#include "text/curve.h"

#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace vdbeam {
namespace {

double number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError(fmt::format("holds \"{}\", which is no number", text));
  return value;
}

} // namespace

Curve::Curve(const std::string& text, std::size_t values) : count_(values) {
  const char* const shape = values == 1 ? "x:y" : "x:r,g,b";
  std::istringstream points(text);
  for (std::string point; points >> point;) {
    const std::size_t colon = point.find(':');
    if (colon == std::string::npos)
      throw InputError(
          fmt::format("must be points {} with spaces between, got \"{}\"", shape, point));
    const double x = number_of(point.substr(0, colon));
    if (!x_.empty() && !(x > x_.back()))
      throw InputError(fmt::format("must ascend, got {:g} after {:g}", x, x_.back()));
    x_.push_back(x);
    std::istringstream list(point.substr(colon + 1));
    std::size_t count = 0;
    for (std::string value; std::getline(list, value, ','); ++count)
      if (values_.emplace_back(number_of(value)) < 0)
        throw InputError(fmt::format("must have no values below 0, got {}", value));
    if (count != values)
      throw InputError(
          fmt::format("must be points {} with spaces between, got \"{}\"", shape, point));
  }
  if (x_.size() < 2)
    throw InputError(fmt::format("must have at least two points {}, got \"{}\"", shape, text));
}

double Curve::at(double x, std::size_t i) const {
  if (!(x > x_.front()))
    return values_[i];
  if (x >= x_.back())
    return values_[(x_.size() - 1) * count_ + i];
  const auto after =
      static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin());
  const double share = (x - x_[after - 1]) / (x_[after] - x_[after - 1]);
  const double a = values_[(after - 1) * count_ + i], b = values_[after * count_ + i];
  return a + share * (b - a);
}

std::string why_no_curve(const std::string& text, std::size_t values) {
  if (text.empty())
    return "";
  try {
    Curve(text, values);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

} // namespace vdbeam
