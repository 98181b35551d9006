#include "scene/default_emission.h"

#include "text/text.h"
#include "volume/blackbody.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Radiance of a mean line through the flames, before the smoke dims it. The core, several times
/// brighter, is white-hot where smoke leaves it open.
constexpr double target_radiance = 3;
/// Temperatures [K] of the hottest flame, and of a flame without a temperature grid: sooty flames
/// have 1200 to 2200 K.
constexpr double hottest_flame = 2200, mean_flame = 1700;
/// A grid that reaches this is in kelvin; simulators also write 0 to 1 or 0 to about 4.
constexpr double surely_kelvin = 600;

/// Summary of one grid over the deciding frames.
struct GridExtent {
  std::string name;
  double maximum = 0;
  double line = 0; ///< integral along a mean line of the longest side

  bool glows() const { return maximum > 0 && std::isfinite(maximum) && line > 0; }
};

constexpr const char* flame_names[] = {"flame", "flame_noise", "flames", "fire", "heat", "burn"};

GridExtent find_extent(const std::vector<std::vector<GridSummary>>& summaries,
                       const std::string& name) {
  GridExtent extent{name};
  for (const std::vector<GridSummary>& grids : summaries)
    for (const GridSummary& grid : grids) {
      const bool scalar = grid.value_type == "float" || grid.value_type == "half";
      if (lower_case(grid.name) != name || !scalar || grid.active_voxels == 0)
        continue;
      extent.name = grid.name;
      double cells = 1, longest = 0;
      for (int i = 0; i < 3; ++i) {
        const auto count = static_cast<double>(grid.index_upper[i] - grid.index_lower[i] + 1);
        cells *= count;
        longest = std::max(longest, count * grid.voxel_size[i]);
      }
      extent.maximum = std::max(extent.maximum, grid.maximum);
      extent.line = std::max(extent.line,
                             grid.mean * longest * static_cast<double>(grid.active_voxels) / cells);
    }
  return extent;
}

GridExtent find_flame(const std::vector<std::vector<GridSummary>>& summaries) {
  for (const char* name : flame_names)
    if (GridExtent extent = find_extent(summaries, name); extent.glows())
      return extent;
  return {};
}

double kelvin_per_unit(const GridExtent& temperature) {
  return temperature.maximum >= surely_kelvin
             ? 1
             : round_to_digits(hottest_flame / temperature.maximum, 2);
}

} // namespace

bool is_fire_grid(const std::string& name) {
  const std::string plain = lower_case(name);
  return plain == "fuel" || plain == "temperature" ||
         std::find(std::begin(flame_names), std::end(flame_names), plain) != std::end(flame_names);
}

double round_to_digits(double x, int digits) {
  if (!(x > 0) || !std::isfinite(x))
    return 1;
  const double unit = std::pow(10, std::floor(std::log10(x)) - (digits - 1));
  return unit < 1 ? std::round(x / unit) / std::round(1 / unit) : std::round(x / unit) * unit;
}

EmissionSettings default_emission(const std::string& path,
                                  const std::vector<std::vector<GridSummary>>& summaries,
                                  std::vector<std::string>& notes) {
  EmissionSettings emission;
  const GridExtent flame = find_flame(summaries);
  const GridExtent temperature = find_extent(summaries, "temperature");
  std::string source;
  if (flame.glows()) {
    emission.intensity = flame.name;
    emission.scale = round_to_digits(target_radiance / flame.line, 2);
    source = fmt::format("grid \"{}\" glows", flame.name);
    if (temperature.glows()) {
      emission.temperature = temperature.name;
      emission.kelvin = kelvin_per_unit(temperature);
      emission.reference = mean_flame;
      source += fmt::format(" in the colours of \"{}\"", temperature.name);
    } else {
      const Vec3d color = blackbody_color(mean_flame);
      for (int c = 0; c < 3; ++c)
        emission.color[c] = static_cast<float>(std::round(color[c] * 100) / 100);
    }
  } else if (temperature.glows() && temperature.maximum >= surely_kelvin) {
    emission.temperature = temperature.name;
    emission.reference = std::clamp(round_to_digits(temperature.maximum, 2), 100.0, 100000.0);
    emission.scale = round_to_digits(target_radiance * temperature.maximum / temperature.line, 2);
    source = fmt::format("grid \"{}\" is taken as kelvin and glows", temperature.name);
  } else {
    return {};
  }
  notes.push_back(fmt::format(
      "{}: {}, with strength {}; change it with --set volume.0.emission.scale=X (0: off)", path,
      source, emission.scale));
  return emission;
}

} // namespace vdbeam
