#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

namespace vdbeam::test {

/// A photometric file (LM-63, type C) with the intensity candela(vertical, horizontal), in degrees.
inline std::string ies_text(const std::vector<double>& vertical,
                            const std::vector<double>& horizontal,
                            const std::function<double(double, double)>& candela) {
  std::string text = "IESNA:LM-63-2002\r\n[TEST] none\r\n[MANUFAC] vdbeam\r\nTILT=NONE\r\n";
  text += fmt::format("1 1000 1 {} {} 1 2 0 0 0\r\n1 1 50\r\n", vertical.size(), horizontal.size());
  const auto add = [&](const std::vector<double>& list) {
    for (const double x : list)
      text += fmt::format("{} ", x);
    text += "\r\n";
  };
  add(vertical);
  add(horizontal);
  for (const double h : horizontal) {
    std::vector<double> plane;
    for (const double v : vertical)
      plane.push_back(candela(v, h));
    add(plane);
  }
  return text;
}

/// From `first` to `last` in equal steps.
inline std::vector<double> angles(double first, double last, int steps) {
  std::vector<double> list;
  for (int i = 0; i <= steps; ++i)
    list.push_back(first + (last - first) * i / steps);
  return list;
}

} // namespace vdbeam::test
