#include "choose/pilot/regression_trial.h"

#include "rays/pixel_tiles.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Sums over a tile's pixels that are fitted to others of the tile only.
struct RegressionSums {
  std::array<double, RegressionTrial::radii.size()> noise{};
  double blur = 0, light = 0;
  double values = 0;

  RegressionSums(const EstimatorInput& input, const TrialTile& tile, double dark) {
    const SeenMedium seen = tile.seen();
    const std::size_t channels = tile.channels();
    for (std::size_t i = 0; i < tile.pixels.size(); ++i) {
      const auto width = static_cast<std::size_t>(input.camera.width());
      const int x = static_cast<int>(tile.pixels[i] % width) - seen.x0;
      const int y = static_cast<int>(tile.pixels[i] / width) - seen.y0;
      constexpr int reach = PixelRegression::widest;
      if (std::min(x, y) < reach || std::max(x, y) >= tile_width - reach)
        continue;
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t at = i * channels + c;
        const double brightness = Spread(tile.wide, tile.places[at]).mean;
        const double weight = trial_weight(tile.known[at] + brightness, dark);
        light += weight * brightness * brightness;
      }
      add_pixel(input, tile, i, x, y, dark);
    }
  }

private:
  void add_pixel(const EstimatorInput& input, const TrialTile& tile, std::size_t i, int x, int y,
                 double dark) {
    PixelRegression::Shares shares;
    const std::size_t channels = tile.channels();
    for (std::size_t r = 0; r < noise.size(); ++r) {
      const PixelRegression fit(input.camera, input.world.space.scale, RegressionTrial::radii[r]);
      const std::span<const PixelRegression::Share> found = fit.shares(tile.seen(), x, y, shares);
      double left = 0;
      for (const PixelRegression::Share& share : found)
        left += static_cast<double>(share.weight) * static_cast<double>(share.weight);
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t at = i * channels + c, place = tile.places[at];
        const double brightness = Spread(tile.wide, place).mean;
        const double weight = trial_weight(tile.known[at] + brightness, dark);
        noise[r] += weight * brightness * brightness * left;
        if (r + 1 < noise.size())
          continue;
        PairedSums changes;
        for (const std::vector<float>& picture : tile.narrow) {
          float change = -picture[place];
          for (const PixelRegression::Share& share : found)
            change += share.weight * picture[c * TileRays::count + tile.ray_of[share.pixel]];
          changes.add(static_cast<double>(change));
        }
        blur += weight * changes.common_square();
        values += 1;
      }
    }
  }
};

} // namespace

RegressionTrial measure_regression(const EstimatorInput& input, const std::vector<TrialTile>& tiles,
                                   double dark) {
  std::vector<std::optional<RegressionSums>> sums(tiles.size());
  tbb::parallel_for(std::size_t{0}, tiles.size(),
                    [&](std::size_t i) { sums[i].emplace(input, tiles[i], dark); });
  RegressionTrial trial;
  double light = 0, values = 0, blur = 0;
  std::array<double, RegressionTrial::radii.size()> noise{};
  for (const auto& tile : sums) { // in their order, for any number of threads
    light += tile->light;
    values += tile->values;
    blur += tile->blur;
    for (std::size_t r = 0; r < noise.size(); ++r)
      noise[r] += tile->noise[r];
  }
  if (!(light > 0) || !(values > 0))
    return trial;
  double error = 0; // squared, of the sum of blur
  for (const auto& tile : sums)
    error += std::pow(tile->blur - blur * tile->values / values, 2);
  for (std::size_t r = 0; r < noise.size(); ++r)
    trial.noise[r] = noise[r] / light;
  trial.blur = tuning::blur_of_walks * (std::max(0.0, blur) + std::sqrt(error)) / values;
  return trial;
}

} // namespace vdbeam
