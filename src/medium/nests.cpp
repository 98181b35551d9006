#include "medium/nests.h"

#include "tuning/constants.h"

#include <algorithm>
#include <numeric>

namespace vdbeam {

namespace {

constexpr std::size_t most_nests = 3;

} // namespace

Nests find_nests(std::span<const double> areas) {
  std::vector<std::size_t> by_size(areas.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t a, std::size_t b) { return areas[a] < areas[b]; });
  Nests nests;
  double sum = 0;
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    const double area = areas[by_size[i]];
    if (sum > 0 && area > tuning::nest_area * sum && nests.size() < most_nests)
      nests.emplace_back(by_size.begin(), by_size.begin() + static_cast<std::ptrdiff_t>(i));
    sum += area;
  }
  for (std::vector<std::size_t>& nest : nests)
    std::sort(nest.begin(), nest.end());
  return nests;
}

} // namespace vdbeam
