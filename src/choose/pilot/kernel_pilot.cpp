#include "choose/pilot/kernel_pilot.h"

#include "choose/pilot/regression_trial.h"
#include "choose/pilot/trial_tile.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbeam {

namespace {

/// Sums over a tile's pixels.
struct TileSums {
  double narrow = 0, wide = 0, change = 0;

  TileSums(const TrialTile& view, double dark) {
    for (std::size_t i = 0; i < view.places.size(); ++i)
      add(view, view.places[i], view.known[i], dark);
  }

private:
  void add(const TrialTile& view, std::size_t place, double known, double dark) {
    const auto count = static_cast<double>(view.narrow.size());
    const Spread n(view.narrow, place), w(view.wide, place);
    const double weight = trial_weight(known + w.mean, dark);
    narrow += weight * n.squares / (count - 1);
    wide += weight * w.squares / (count - 1);
    PairedSums changes;
    for (std::size_t m = 0; m < view.narrow.size(); ++m)
      changes.add(static_cast<double>(view.wide[m][place]) -
                  static_cast<double>(view.narrow[m][place]));
    change += weight * changes.common_square();
  }
};

/// A regular sample of the tile's pixels, with their weights.
void add_pixels(const TrialTile& view, std::size_t step, double dark,
                std::vector<TrialPixel>& pixels) {
  const std::size_t channels = view.channels();
  for (std::size_t i = 0; i < view.pixels.size(); i += step) {
    TrialPixel sample{view.pixels[i], {}};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = i * channels + std::min(c, channels - 1);
      const double mean = Spread(view.wide, view.places[at]).mean;
      sample.weight[static_cast<int>(c)] =
          static_cast<float>(trial_weight(view.known[at] + mean, dark));
    }
    pixels.push_back(sample);
  }
}

} // namespace

KernelErrors measure_kernels(const EstimatorInput& input, const PhotonPlan& plan,
                             const KernelTrial& narrow, const KernelTrial& wide, const RngKey& key,
                             std::uint64_t& rays) {
  const std::vector<TilePlace> tiles = choose_trial_tiles(input.camera);
  std::vector<TrialTile> views(tiles.size());
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
    if (!input.stopped())
      views[i] = view_trial_tile(input, plan, tiles[i], narrow.maps, wide.maps, key);
  });
  rays += tiles.size() * TileRays::count;
  if (input.stopped())
    return {};
  // In the order of the tiles, so that sums are the same for any number of threads.
  double brightness = 0, pixels = 0;
  for (const TrialTile& view : views) {
    brightness += view.brightness;
    pixels += static_cast<double>(view.places.size());
  }
  KernelErrors errors;
  if (!(brightness > 0))
    return errors;
  const double dark = tuning::dark_offset * brightness / pixels;
  std::vector<TileSums> sums;
  sums.reserve(views.size());
  for (const TrialTile& view : views)
    sums.emplace_back(view, dark);
  for (const TileSums& tile : sums) {
    errors.noise_narrow += tile.narrow;
    errors.noise_wide += tile.wide;
    errors.change += tile.change;
  }
  const double mean = errors.change / static_cast<double>(tiles.size());
  for (const TileSums& tile : sums)
    errors.change_error += (tile.change - mean) * (tile.change - mean);
  errors.change_error = std::sqrt(errors.change_error);
  for (double* sum :
       {&errors.noise_narrow, &errors.noise_wide, &errors.change, &errors.change_error})
    *sum /= pixels;
  std::size_t hits = 0;
  for (const TrialTile& view : views)
    hits += view.pixels.size();
  const std::size_t step = std::clamp(hits / tuning::fewest_trial_pixels, std::size_t{1},
                                      tuning::pixels_between_samples);
  for (const TrialTile& view : views)
    add_pixels(view, step, dark, errors.pixels);
  errors.regression = measure_regression(input, views, dark);
  return errors;
}

KernelModel::KernelModel(const KernelTrial& narrow, const KernelTrial& wide,
                         const KernelErrors& errors, double paths_share, double alpha)
    : narrow_(narrow.neighbours), wide_(wide.neighbours), noise_(errors.noise_narrow * paths_share),
      alpha_(alpha) {
  const double ratio = wide_ / narrow_;
  if (errors.noise_narrow > 0 && errors.noise_wide > 0)
    noise_power_ =
        std::clamp(std::log(errors.noise_narrow / errors.noise_wide) / std::log(ratio), 0.3, 1.0);
  else
    noise_ = 0;
  const double per_change = std::pow(std::pow(ratio, tuning::bias_power) - 1, -2);
  bias_ = expected_bias(errors.change * per_change, errors.change_error * per_change);
}

double KernelModel::expected_bias(double measured, double error) const {
  if (!(noise_ > 0) || !(error > 0))
    return std::max(0.0, measured);
  // The bias at which the usual kernels are best; the best number goes as its -1 / power.
  const double power = noise_power_ + 2 * tuning::bias_power;
  const Balance at = balance(tuning::balanced_passes);
  const double usual = noise_power_ * at.noise / (2 * tuning::bias_power * at.bias_factor) *
                       std::pow(tuning::usual_neighbours / narrow_, -power);
  // Bayes' theorem, in small steps of the best number of photons from 2^-8 to 2^8 times the usual
  // one. The largest logarithm of a weight is taken off, or all might vanish.
  constexpr int steps = 256;
  std::array<double, 2 * steps + 1> bias, logarithm;
  for (int i = 0; i <= 2 * steps; ++i) {
    const double octaves = 8.0 / steps * (i - steps);
    bias[i] = usual * std::exp2(-power * octaves);
    const double off = (measured - bias[i]) / error, unusual = octaves / tuning::usual_octaves;
    logarithm[i] = -0.5 * (off * off + unusual * unusual);
  }
  const double largest = *std::max_element(logarithm.begin(), logarithm.end());
  double sum = 0, weights = 0;
  for (int i = 0; i <= 2 * steps; ++i) {
    const double weight = std::exp(logarithm[i] - largest);
    sum += weight * bias[i];
    weights += weight;
  }
  return sum / weights;
}

/// Radii go as the cube root of the neighbours; both powers hold for what the passes shrink too.
KernelModel::Balance KernelModel::balance(int passes) const {
  double noise = 0, bias_factor = 0;
  double shrink = 1;
  for (int pass = 1; pass <= passes; ++pass) {
    noise += std::pow(shrink, -1.5 * noise_power_);
    bias_factor += std::pow(shrink, 1.5 * tuning::bias_power);
    shrink *= (pass + alpha_) / (pass + 1);
  }
  noise *= noise_ / (static_cast<double>(passes) * passes);
  bias_factor /= passes;
  return {noise, bias_factor * bias_factor};
}

double KernelModel::best_neighbours() const {
  // Where narrow kernels reach no camera ray, photons are too few for any but wide ones.
  if (!(noise_ > 0) || !(bias_ > 0))
    return wide_;
  const Balance at = balance(tuning::balanced_passes);
  // noise x^-power + bias x^(2 tuning::bias_power) is least where its derivative is 0.
  const double x =
      std::pow(noise_power_ * at.noise / (2 * tuning::bias_power * bias_ * at.bias_factor),
               1 / (noise_power_ + 2 * tuning::bias_power));
  return std::max(tuning::fewest_neighbours, std::min(narrow_ * x, wide_));
}

double KernelModel::error(double neighbours, int passes) const {
  const Balance at = balance(passes);
  const double x = neighbours / narrow_;
  return at.noise * std::pow(x, -noise_power_) +
         bias_ * at.bias_factor * std::pow(x, 2 * tuning::bias_power);
}

} // namespace vdbeam
