#include "errors/error_estimate.h"
#include "errors/history_means.h"
#include "errors/pair_weights.h"
#include "errors/regional_bias.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

namespace vdbeam {
namespace {

/// Value and standard error by leaving out each batch in turn (jackknife).
template <class Value>
std::pair<double, double> jackknife(std::size_t count, const Value& without) {
  const double whole = without(count), n = static_cast<double>(count);
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i)
    squares += (without(i) - whole) * (without(i) - whole);
  return {whole, std::sqrt(squares * (n - 1) / n)};
}

/// Differences to the probes, and of the mean brightness.
struct ProbeDifferences : Differences {
  double difference = 0, brightness = 0;
};

ProbeDifferences compare_probes(const PassHistory& history, std::size_t batch) {
  ProbeDifferences result;
  result.weights.resize(history.pixels().size());
  result.sums.resize(3 * result.weights.size());
  for (std::size_t i = 0; i < history.pixels().size(); ++i) {
    const double probes = static_cast<double>(history.probes(batch)[i]);
    if (probes == 0)
      continue;
    result.weights[i] = probes;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const double value = static_cast<double>(history.sums(batch)[k]) / history.passes(batch);
      result.sums[k] = probes * value - static_cast<double>(history.probe_sums(batch)[k]);
      result.difference += result.sums[k];
      result.brightness += probes * value;
    }
  }
  return result;
}

Differences compare_kernels(const PassHistory& history, std::size_t batch) {
  Differences result;
  result.weights.assign(history.blurs(batch), history.blurs(batch) + history.pixels().size());
  result.sums.assign(history.blur_sums(batch),
                     history.blur_sums(batch) + 3 * result.weights.size());
  return result;
}

/// Truncation of the mean of all passes, over that of a pass for which it is 1.
double mean_truncation(const PassHistory& history) {
  double sum = 0;
  for (std::size_t batch = 0; batch < history.batches(); ++batch)
    sum += history.truncation(batch);
  return sum / total_passes(history);
}

/// Adds the bias of the truncation to the kernels' bias, by linear regression over the passes of a
/// batch, which differ in their truncation. A batch whose passes do not differ has no
/// weight. `mean`: truncation of all passes.
void add_truncation(const PassHistory& history, std::size_t batch, double mean,
                    Differences& biases) {
  constexpr double least_variation = 0.01;
  const double n = history.passes(batch), t = history.truncation(batch) / n;
  const double spread = history.truncation_squares(batch) - n * t * t;
  if (!(spread > n * t * t * least_variation * least_variation)) {
    std::fill(biases.weights.begin(), biases.weights.end(), 0.0);
    return;
  }
  for (std::size_t k = 0; k < biases.sums.size(); ++k) {
    const double products = static_cast<double>(history.truncated_sums(batch)[k]);
    const double slope = (products - t * static_cast<double>(history.sums(batch)[k])) / spread;
    biases.sums[k] += slope * mean * biases.weights[k / 3];
  }
}

/// Products of the differences of all pairs of batches, of some of the pixels.
struct PairProducts {
  std::vector<double> products, weights; ///< by pair, i * batches + j with j < i
  double squares = 0;                    ///< of each pixel's sum over its pairs

  explicit PairProducts(std::size_t pairs) : products(pairs), weights(pairs) {}

  void add(const PairProducts& other) {
    std::transform(products.begin(), products.end(), other.products.begin(), products.begin(),
                   std::plus<>());
    std::transform(weights.begin(), weights.end(), other.weights.begin(), weights.begin(),
                   std::plus<>());
    squares += other.squares;
  }
};

/// Adds those of a followed pixel.
template <class Batch>
void add_pixel(const std::vector<Batch>& batches, const PairWeights& pair_weight, std::size_t g,
               PairProducts& to) {
  const std::size_t count = batches.size();
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double a = batches[i].weights[g], b = batches[j].weights[g];
      if (!(a * b > 0))
        continue;
      const double weight = std::sqrt(a * b);
      double product = 0;
      for (std::size_t k = 3 * g; k < 3 * g + 3; ++k)
        product +=
            weight / 3 * pair_weight(i, j, k) * batches[i].sums[k] / a * batches[j].sums[k] / b;
      to.products[i * count + j] += product;
      to.weights[i * count + j] += weight;
      sum += product;
    }
  to.squares += sum * sum;
}

/// The mean square, over pixels and channels, of what the differences of all batches have in
/// common, and its standard error: products of independent batches, pixel by pixel. Noise has none
/// on average, bias has its square, of whatever sign it is in the next pixel. Few batches may agree
/// by chance, so the error is no smaller than if pixels were independent of one another.
template <class Batch>
std::pair<double, double> common_square(const std::vector<Batch>& batches,
                                        const PairWeights& pair_weight) {
  constexpr std::size_t pixels_per_block = 128;
  const std::size_t count = batches.size(), pixels = batches[0].weights.size();
  std::vector<PairProducts> blocks((pixels + pixels_per_block - 1) / pixels_per_block,
                                   PairProducts(count * count));
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    const std::size_t begin = block * pixels_per_block;
    for (std::size_t g = begin; g < std::min(pixels, begin + pixels_per_block); ++g)
      add_pixel(batches, pair_weight, g, blocks[block]);
  });
  PairProducts all(count * count); // in the order of the pixels, for any number of threads
  for (const PairProducts& block : blocks)
    all.add(block);
  double all_weights = 0;
  const auto [value, error] = jackknife(count, [&](std::size_t left_out) {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (i != left_out && j != left_out) {
          sum += all.products[i * count + j];
          weight += all.weights[i * count + j];
        }
    all_weights = std::max(all_weights, weight);
    return weight > 0 ? sum / weight : BiasStatistics::unknown;
  });
  return {value, std::max(error, std::sqrt(all.squares) / all_weights)};
}

/// Contribution of the truncation of the forward peak to the squared bias, and its
/// standard error; NaN if unknown.
std::pair<double, double> truncation_square(const PassHistory& passes) {
  const PassHistory history = passes.with_several_passes_per_batch();
  const std::size_t count = history.batches();
  const double truncation = mean_truncation(history);
  if (count < fewest_batches || !(truncation > 0))
    return {BiasStatistics::unknown, BiasStatistics::unknown};
  std::vector<Differences> kernels(count), both(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t batch) {
    kernels[batch] = compare_kernels(history, batch);
    both[batch] = kernels[batch];
    add_truncation(history, batch, truncation, both[batch]);
  });
  const PairWeights pair_weight(history, kernels);
  const auto [square, error] = common_square(both, pair_weight);
  return {square - common_square(kernels, pair_weight).first, error};
}

} // namespace

BiasStatistics bias_statistics(const PassHistory& history) {
  const std::size_t count = history.batches();
  if (count < fewest_batches)
    return {};
  std::vector<ProbeDifferences> probes(count);
  std::vector<Differences> kernels(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t batch) {
    probes[batch] = compare_probes(history, batch);
    kernels[batch] = compare_kernels(history, batch);
  });
  const PairWeights pair_weight(history, kernels);
  const auto [bias, bias_error] = jackknife(count, [&](std::size_t left_out) {
    double difference = 0, brightness = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (i != left_out) {
        difference += probes[i].difference;
        brightness += probes[i].brightness;
      }
    return brightness != difference ? difference / (brightness - difference)
                                    : BiasStatistics::unknown;
  });
  const auto [mrse, mrse_error] = common_square(probes, pair_weight);
  const auto [blur, blur_error] = common_square(kernels, pair_weight);
  const RegionalBias of_probes(history, {probes.begin(), probes.end()}),
      of_kernels(history, kernels);
  BiasStatistics statistics{mrse, mrse_error, bias, bias_error, blur, blur_error};
  std::tie(statistics.truncation, statistics.truncation_error) = truncation_square(history);
  std::tie(statistics.hidden, statistics.hidden_error) = jackknife(
      count, [&](std::size_t out) { return of_probes.without(out) - of_kernels.without(out); });
  return statistics;
}

} // namespace vdbeam
