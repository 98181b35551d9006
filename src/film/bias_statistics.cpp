#include "film/error_estimate.h"
#include "film/history_means.h"
#include "film/pair_weights.h"
#include "film/regional_bias.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

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
  for (double& sum : result.sums)
    sum /= PassImage::shown_blur();
  return result;
}

/// The mean square, over pixels and channels, of what the differences of all batches have in
/// common, and its standard error: products of independent batches, pixel by pixel. Noise has none
/// on average, bias has its square, of whatever sign it is in the next pixel.
template <class Batch>
std::pair<double, double> common_square(const std::vector<Batch>& batches,
                                        const PairWeights& pair_weight) {
  const std::size_t count = batches.size();
  std::vector<double> products(count * count), weights(count * count);
  tbb::parallel_for(std::size_t{0}, count * count, [&](std::size_t at) {
    const std::size_t i = at / count, j = at % count;
    for (std::size_t g = 0; j < i && g < batches[i].weights.size(); ++g) {
      const double a = batches[i].weights[g], b = batches[j].weights[g];
      if (!(a * b > 0))
        continue;
      const double weight = std::sqrt(a * b);
      for (std::size_t k = 3 * g; k < 3 * g + 3; ++k)
        products[at] +=
            weight / 3 * pair_weight(i, j, k) * batches[i].sums[k] / a * batches[j].sums[k] / b;
      weights[at] += weight;
    }
  });
  return jackknife(count, [&](std::size_t left_out) {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (i != left_out && j != left_out) {
          sum += products[i * count + j];
          weight += weights[i * count + j];
        }
    return weight > 0 ? sum / weight : unknown;
  });
}

} // namespace

BiasStatistics bias_statistics(const PassHistory& history) {
  const std::size_t count = history.batches();
  if (count < fewest_batches)
    return {unknown, unknown, unknown, unknown, unknown, unknown, unknown, unknown};
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
    return brightness != difference ? difference / (brightness - difference) : unknown;
  });
  const auto [mrse, mrse_error] = common_square(probes, pair_weight);
  const auto [blur, blur_error] = common_square(kernels, pair_weight);
  const RegionalBias of_probes(history, {probes.begin(), probes.end()}),
      of_kernels(history, kernels);
  const auto [hidden, hidden_error] = jackknife(count, [&](std::size_t left_out) {
    return of_probes.without(left_out) - of_kernels.without(left_out);
  });
  return {mrse, mrse_error, bias, bias_error, blur, blur_error, hidden, hidden_error};
}

} // namespace vdbeam
