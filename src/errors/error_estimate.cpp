#include "errors/error_estimate.h"

#include "errors/history_means.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

constexpr std::size_t batches_of_interval = fewest_batches;

/// 97.5 % quantile of the normal distribution.
constexpr double normal_quantile = 1.959964;

/// 97.5 % quantile of Student's t (Abramowitz and Stegun 26.7.5).
double student(double degrees) {
  constexpr double z = normal_quantile, z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * degrees) + (5 * z5 + 16 * z3 + 3 * z) / (96 * degrees * degrees) +
         (3 * z5 * z * z + 19 * z5 + 17 * z3 - 15 * z) / (384 * degrees * degrees * degrees);
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  std::array<double, 8> sums{}; // so that compilers may vectorise
  std::size_t i = 0;
  for (; i + sums.size() <= a.size(); i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k)
      sums[k] += static_cast<double>(a[i + k]) * static_cast<double>(b[i + k]);
  for (; i < a.size(); ++i)
    sums[0] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  double sum = 0;
  for (const double part : sums)
    sum += part;
  return sum;
}

/// Deviations of the batches from the mean, in units of MRSE.
struct Deviations {
  std::vector<std::vector<float>> batches; ///< sqrt(passes) times the weighted deviation
  double plain = 0;    ///< sum of squares with weights 1 / (mean + mrse_offset)^2
  double diagonal = 0; ///< sum over pixels of the square of their variance

  /// A weight must know nothing of the deviation that it weighs, or pixels with a rare bright pass
  /// would hide it under the brightness it caused. So a batch is weighed by the mean of the others
  /// and, where they are few, of the neighbours. The mean of 1 / (m + mrse_offset)^2 over a noisy m
  /// is too large by 3 Var(m) / (m + mrse_offset)^4 to first order, which is taken off.
  Deviations(const PassHistory& history, double passes) : batches(history.batches()) {
    const std::vector<float> means = mean_of(history, passes);
    const std::vector<float> around = smoothed(means, history.columns(), history.rows());
    for (std::vector<float>& batch : batches)
      batch.resize(means.size());
    const double neighbours =
        tuning::weight_of_neighbours * passes / static_cast<double>(batches.size());
    for (std::size_t i = 0; i < means.size(); i += 3) {
      double variance = 0;
      for (std::size_t c = i; c < i + 3; ++c)
        variance += add_value(history, passes, c, means[c], around[c], neighbours);
      diagonal += variance * variance;
    }
  }

private:
  double add_value(const PassHistory& history, double passes, std::size_t i, float value,
                   float around, double neighbours) {
    const double mean = static_cast<double>(value), count = static_cast<double>(batches.size());
    std::array<double, PassHistory::most_batches> squares{};
    double sum = 0, weighted = 0;
    for (std::size_t b = 0; b < batches.size(); ++b) {
      const double n = history.passes(b), d = static_cast<double>(history.sums(b)[i]) / n - mean;
      squares[b] = n * d * d;
      sum += squares[b];
    }
    plain += sum / ((mean + mrse_offset) * (mean + mrse_offset));
    for (std::size_t b = 0; b < batches.size(); ++b) {
      const double n = history.passes(b), others = passes - n;
      const double d = static_cast<double>(history.sums(b)[i]) / n - mean;
      const double others_mean = mean - d * n / others;
      const double variance = std::max(0.0, sum - squares[b] * passes / others) / (count - 2);
      const double expected =
          (others_mean * others + neighbours * static_cast<double>(around)) / (others + neighbours);
      const double m = std::max({0.0, expected, tuning::least_mean_of_others * mean});
      const double weight =
          1 / ((m + mrse_offset) * (m + mrse_offset) +
               3 * variance * others / ((others + neighbours) * (others + neighbours)));
      weighted += squares[b] * weight;
      batches[b][i] = static_cast<float>(std::sqrt(n * weight) * d);
    }
    return weighted / (count - 1);
  }
};

/// 1 / degrees of freedom of the image's error: the trace of the squared covariance of a pass over
/// the square of its trace, from the scalar products of independent passes.
double inverse_degrees(const PassHistory& history, const Deviations& deviations,
                       const std::vector<double>& products, double passes, double trace) {
  const std::size_t count = deviations.batches.size();
  double sum = 0, expected = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double a = history.passes(i) / passes, b = history.passes(j) / passes;
      // Deviations from the common mean have the correlation -sqrt(a b), which carries no
      // information.
      const double product = products[i * count + j] + std::sqrt(a * b) * trace;
      sum += product * product;
      expected += (1 - a) * (1 - b) + a * b;
    }
  const double all_pairs = sum / expected;
  // Followed pixels represent their neighbours for the noise that pixels share, but not for the
  // independent noise of each pixel.
  const double own = deviations.diagonal / (1 + 2 / static_cast<double>(count - 1));
  const double squares = std::max(all_pairs - (1 - history.share()) * own, history.share() * own);
  return squares / (trace * trace);
}

} // namespace

NoiseStatistics noise_statistics(const PassHistory& history) {
  const std::size_t count = history.batches();
  if (count < fewest_batches)
    return {};
  const double passes = total_passes(history);
  const Deviations deviations(history, passes);
  std::vector<double> products(count * count);
  tbb::parallel_for(std::size_t{0}, count * count, [&](std::size_t k) {
    if (k % count <= k / count)
      products[k] = dot(deviations.batches[k / count], deviations.batches[k % count]);
  });
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i)
    squares += products[i * count + i];
  NoiseStatistics statistics;
  statistics.batches = static_cast<int>(count);
  statistics.spread = tuning::uncertainty_of_weights;
  if (!(squares > 0) || !(deviations.plain > 0))
    return statistics;
  statistics.correction = squares / deviations.plain;
  const double trace = squares / static_cast<double>(count - 1);
  // The differences between the batches' squares give the standard error of their sum.
  double uneven = 0;
  for (std::size_t i = 0; i < count; ++i)
    uneven += std::pow(products[i * count + i] * static_cast<double>(count) / squares - 1, 2);
  uneven /= static_cast<double>(count) * static_cast<double>(count - 1);
  statistics.spread =
      std::sqrt(2 * inverse_degrees(history, deviations, products, passes, trace) + uneven +
                tuning::uncertainty_of_weights * tuning::uncertainty_of_weights);
  return statistics;
}

namespace {

/// A squared bias [MRSE] and its standard error.
struct SquaredBias {
  double value = 0, error = 0;
};

double positive_part(double square, double error, double shrinkage) {
  return square > 0 ? std::max(0.0, square - shrinkage * error * error / square) : 0;
}

/// The mean of two, each weighted by how well it is known; the first where the second is not.
SquaredBias average(const SquaredBias& first, const SquaredBias& second) {
  const auto weight = [](const SquaredBias& one) {
    const bool known = std::isfinite(one.value) && std::isfinite(one.error) && one.error > 0;
    return known ? 1 / (one.error * one.error) : 0;
  };
  const double a = weight(first), b = weight(second);
  if (b == 0 || first.error == 0)
    return first;
  if (a == 0)
    return second;
  return {(a * first.value + b * second.value) / (a + b), 1 / std::sqrt(a + b)};
}

/// What probes find in large regions beyond what kernels and the truncation explain. `more`: factor
/// of standard errors of few batches.
SquaredBias beyond_truncation(const BiasStatistics& bias, double more) {
  const double error = std::hypot(bias.hidden_error, bias.truncation_error);
  if (!std::isfinite(error) || !std::isfinite(bias.hidden - bias.truncation))
    return {};
  return {positive_part(bias.hidden - bias.truncation, error * more, tuning::shrinkage_of_probes),
          error};
}

/// The squared bias from kernels of other widths and from probes, weighted by their precision.
/// Where only probes are, small values are noise more likely than bias. `t`: quantile of the
/// batches that give the standard errors.
SquaredBias squared_bias(const BiasStatistics& bias, double noise, double t) {
  const bool probed = std::isfinite(bias.mrse) && std::isfinite(bias.mrse_error);
  if (!std::isfinite(bias.blur) || !std::isfinite(bias.blur_error)) {
    if (!probed)
      return {};
    return {positive_part(bias.mrse, bias.mrse_error, tuning::shrinkage_of_probes),
            bias.mrse_error};
  }
  SquaredBias result;
  result.value = positive_part(bias.blur, bias.blur_error, tuning::shrinkage_of_blur);
  result.error = std::hypot(bias.blur_error, tuning::uncertainty_of_blur * result.value,
                            tuning::unseen_bias * noise);
  result = average(result, {bias.mrse, bias.mrse_error});
  result.value = std::max(0.0, result.value);
  // What nobody has seen yet widens the interval; it must not let rays that are too few to see it
  // outvote the kernels.
  const SquaredBias rest =
      average({bias.hidden, bias.hidden_error}, {bias.truncation, bias.truncation_error});
  if (std::isfinite(rest.value)) {
    // Three batches that agree by chance would make a bias of what is noise.
    const double more = t / normal_quantile;
    result.value += positive_part(rest.value, rest.error * more, tuning::shrinkage_of_probes);
    // Truncation is known better than what probes find, but need not be all of it.
    if (const SquaredBias other = beyond_truncation(bias, more); other.value > 0)
      result = {result.value + other.value, std::hypot(result.error, other.error)};
    const double expected = tuning::expected_bias * (noise + result.value);
    if (rest.error > 0 && expected > 0)
      result.error = std::hypot(result.error, 1 / std::hypot(1 / rest.error, 1 / expected));
  } else if (!probed) { // nobody looks for it
    result.error = std::hypot(result.error, tuning::expected_bias * (noise + result.value));
  }
  return result;
}

} // namespace

ErrorEstimate combine_errors(double noise, const NoiseStatistics& statistics,
                             const BiasStatistics& bias, bool unbiased) {
  ErrorEstimate estimate{};
  estimate.noise = noise * statistics.correction;
  const double batches = statistics.batches;
  const double t = student(std::max(1.0, batches - 1));
  estimate.bias_mrse = estimate.bias = estimate.bias_margin =
      unbiased ? 0 : BiasStatistics::unknown;
  SquaredBias part;
  if (!unbiased) {
    part = squared_bias(bias, estimate.noise, t);
    estimate.bias_mrse = std::isfinite(bias.blur) ? part.value : bias.mrse;
    estimate.bias = bias.bias;
    estimate.bias_margin = t * bias.bias_error;
  }
  estimate.mrse = estimate.noise + part.value;
  estimate.low = estimate.high = BiasStatistics::unknown;
  if (statistics.batches < static_cast<int>(batches_of_interval))
    return estimate;
  const double factor = std::exp(student(2 * (batches - 1)) * statistics.spread);
  const double margin = t * part.error;
  const double below = std::hypot(estimate.noise * (1 - 1 / factor), std::min(part.value, margin));
  estimate.low = std::max(0.0, estimate.mrse - below);
  estimate.high = estimate.mrse + std::hypot(estimate.noise * (factor - 1), margin);
  return estimate;
}

} // namespace vdbeam
