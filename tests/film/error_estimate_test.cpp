#include "errors/error_estimate.h"

#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vdbeam {
namespace {

constexpr int width = 48, height = 40;
constexpr float mean = 1;

/// A pass around 1 whose squares of `block` x `block` pixels share their noise.
PassImage noisy_pass(int block, double sigma, std::mt19937& random) {
  std::normal_distribution<double> normal(0, sigma);
  PassImage pass;
  pass.resize(width, height);
  const int columns = (width + block - 1) / block;
  std::vector<float> noise;
  for (int i = 0; i < columns * ((height + block - 1) / block); ++i)
    noise.push_back(static_cast<float>(normal(random)));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      pass.indirect[static_cast<std::size_t>(y * width + x)] =
          Rgb(mean + noise[static_cast<std::size_t>(y / block * columns + x / block)]);
  return pass;
}

TEST(NoiseStatistics, CountsWhatPixelsShare) {
  // For n passes whose m squares are independent and Gaussian, the logarithm of true over estimated
  // MRSE has the variance 2 / m + 2 / (m (n - 1)). It is estimated from 120 pairs of passes,
  // to some 13 % of the variance; 4 times that is allowed.
  for (const int block : {1, 2, 4, 8}) {
    std::mt19937 random(7);
    Film film(width, height);
    PassHistory history(width, height);
    for (int i = 0; i < 16; ++i)
      history.add(noisy_pass(block, 0.05, random), {});
    const NoiseStatistics statistics = noise_statistics(history);
    const double squares = width * height / (block * block);
    const double expected = 2 / squares * (1 + 1.0 / 15) + 0.03 * 0.03;
    EXPECT_NEAR(statistics.spread * statistics.spread / expected, 1, 0.5) << block;
    EXPECT_NEAR(statistics.correction, 1, 0.02) << block;
  }
}

TEST(NoiseStatistics, RareBrightPassesDoNotHideTheirNoise) {
  // Each value is 5 with a chance of 1 / 5, else 0: weights by the mean of all passes see bright
  // pixels as less noisy and dark ones as free of noise.
  std::mt19937 random(3);
  std::bernoulli_distribution bright(0.2);
  const int passes = 64;
  const double variance = 25 * 0.2 * 0.8 / passes, truth = variance / (1.01 * 1.01);
  Film film(width, height);
  PassImage pass;
  pass.resize(width, height);
  for (int i = 0; i < passes; ++i) {
    for (Rgb& value : pass.indirect)
      value = Rgb(bright(random) ? 5.0f : 0.0f);
    film.add(pass);
  }
  const ErrorEstimate estimate = film.error_estimate(true);
  EXPECT_NEAR(estimate.noise / truth, 1, 0.1);
  EXPECT_GT(std::abs(film.mrse_estimate() / truth - 1), 0.05) << "the plain estimate is no better";
}

TEST(PassHistory, BatchesDoubleAndHoldEveryPass) {
  std::mt19937 random(1);
  const PassImage pass = noisy_pass(4, 0.1, random);
  PassHistory history(width, height);
  for (int i = 1; i <= 1000; ++i) {
    history.add(pass, {});
    double passes = 0;
    for (std::size_t batch = 0; batch < history.batches(); ++batch) {
      EXPECT_EQ(history.passes(batch), history.passes(0));
      passes += history.passes(batch);
    }
    EXPECT_GT(passes, 0.87 * i); // what is left is the batch that fills up
    EXPECT_GE(static_cast<int>(history.batches()), std::min(i, 8));
  }
  const double sum = static_cast<double>(history.sums(2)[0]);
  EXPECT_NEAR(sum / history.passes(2), static_cast<double>(pass.indirect[0].x), 1e-4);
}

TEST(PassHistory, FollowsPixelsOfLargePictures) {
  for (const auto& [w, h] : {std::pair{1920, 1080}, {1, 30000}, {64, 64}, {65, 64}, {1, 1}}) {
    const PassHistory history(w, h);
    EXPECT_LE(history.pixels().size(), PassHistory::most_samples);
    EXPECT_GE(history.pixels().size(), std::min<std::size_t>(static_cast<std::size_t>(w) * h,
                                                             PassHistory::most_samples / 8));
    for (const std::size_t pixel : history.pixels())
      EXPECT_LT(pixel, static_cast<std::size_t>(w) * h);
  }
}

TEST(BiasStatistics, IsTheDifferenceToTheProbes) {
  // A picture of 1.1 and probes of 1, both noisy; half of the pixels are probed in each pass.
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0, 0.3f);
  Film film(width, height);
  for (int i = 0; i < 40; ++i) {
    PassImage pass = noisy_pass(8, 0.1, random);
    for (Rgb& value : pass.indirect)
      value += Rgb(0.1f);
    std::vector<PixelValue> probes;
    for (std::size_t k = static_cast<std::size_t>(i % 2); k < film.probe_pixels().size(); k += 2)
      probes.push_back({film.probe_pixels()[k], Rgb(mean + noise(random))});
    film.add(pass, probes);
  }
  const ErrorEstimate estimate = film.error_estimate(false);
  // 4 standard errors: noise of 0.1 in 30 squares and 40 passes, and of 0.3 in 38,400 probes.
  EXPECT_NEAR(estimate.bias, 0.1, 4 * std::hypot(0.1 / std::sqrt(30 * 40), 0.3 / std::sqrt(38400)));
  EXPECT_GT(estimate.bias_margin, 0.002);
  EXPECT_LT(estimate.bias_margin, 0.02);
  EXPECT_NEAR(estimate.bias_mrse, std::pow(0.1 / 1.11, 2), 0.0015);
  EXPECT_GT(estimate.high, estimate.mrse);
  EXPECT_LT(estimate.low, estimate.mrse);
  EXPECT_NEAR(estimate.mrse, estimate.noise + estimate.bias_mrse, 1e-4);

  const ErrorEstimate without = film.error_estimate(true);
  EXPECT_EQ(without.bias, 0);
  EXPECT_EQ(without.mrse, without.noise);
}

/// Kernels blur: what they take from one pixel they give to the next.
TEST(BiasStatistics, SeesABiasThatChangesSignFromPixelToPixel) {
  std::mt19937 random(12);
  std::normal_distribution<float> noise(0, 0.3f);
  Film film(width, height);
  for (int i = 0; i < 40; ++i) {
    PassImage pass = noisy_pass(8, 0.1, random);
    for (std::size_t k = 0; k < pass.indirect.size(); ++k)
      pass.indirect[k] += Rgb((k + k / width) % 2 == 0 ? 0.1f : -0.1f);
    std::vector<PixelValue> probes;
    for (std::size_t k = static_cast<std::size_t>(i % 2); k < film.probe_pixels().size(); k += 2)
      probes.push_back({film.probe_pixels()[k], Rgb(mean + noise(random))});
    film.add(pass, probes);
  }
  const ErrorEstimate estimate = film.error_estimate(false);
  // 4 standard errors of the mean over the pixels of products of noise of 0.3 each.
  const double square = std::pow(0.1 / 1.01, 2);
  EXPECT_NEAR(estimate.bias_mrse, square, 0.0025);
  EXPECT_NEAR(estimate.bias, 0, 0.02);
  EXPECT_LT(estimate.low, estimate.noise + square);
  EXPECT_GT(estimate.high, estimate.noise + square);
}

/// Kernels of another width reveal a bias that few, noisy probes do not.
TEST(BiasStatistics, FollowsFromOtherKernels) {
  std::mt19937 random(13);
  std::normal_distribution<float> noise(0, 1), little_noise(0, 0.05f);
  Film film(width, height);
  for (int i = 0; i < 20; ++i) {
    PassImage pass = noisy_pass(8, 0.1, random);
    std::vector<PixelValue> probes;
    for (std::size_t k = 0; k < film.probe_pixels().size(); ++k) {
      const std::size_t pixel = film.probe_pixels()[k];
      const float sign = pixel % 2 == 0 ? 1 : -1;
      pass.indirect[pixel] += Rgb(sign * 0.1f);
      if (k % 2 == 0)
        pass.blur.push_back({pixel, Rgb(sign * 0.1f + little_noise(random))});
      if ((k + static_cast<std::size_t>(i)) % 40 == 0)
        probes.push_back({pixel, Rgb(mean + noise(random))});
    }
    film.add(pass, probes);
  }
  const ErrorEstimate estimate = film.error_estimate(false);
  const double square = std::pow(0.1 / 1.01, 2);
  EXPECT_NEAR(estimate.bias_mrse, square, 0.001);
  EXPECT_LT(estimate.low, estimate.noise + square);
  EXPECT_GT(estimate.high, estimate.noise + square);
  EXPECT_LT(estimate.high, estimate.noise + 5 * square);
}

/// A pass, pixel by pixel +0.1 or -0.1 times its truncation away from `mean`, and its blur: none.
PassImage truncated_pass(float truncation, std::mt19937& random) {
  std::normal_distribution<float> little_noise(0, 0.01f);
  PassImage pass = noisy_pass(1, 0.1, random);
  pass.truncation = truncation;
  for (std::size_t i = 0; i < pass.indirect.size(); ++i) {
    pass.indirect[i] += Rgb((i + i / width) % 2 == 0 ? 0.1f : -0.1f) * truncation;
    pass.blur.push_back({i, Rgb(little_noise(random))});
  }
  return pass;
}

/// Passes that take more and less of the forward peak out reveal the bias of
/// both.
TEST(BiasStatistics, FollowsFromTruncation) {
  for (const int passes : {8, 11, 40, 200}) {
    std::mt19937 random(17);
    Film film(width, height);
    PassHistory history(width, height);
    for (int i = 0; i < passes; ++i)
      history.add(truncated_pass(i % 2 == 0 ? 1.2f : 0.6f, random), {});
    const BiasStatistics statistics = bias_statistics(history);
    const double n = passes, mean_truncation = (n / 2 + passes % 2 * 0.5) / n * 0.6 + 0.6;
    const double square = std::pow(0.1 * mean_truncation / 1.01, 2);
    // 4 standard errors: 1 / 2 square root of n times 0.1 is the error of a difference of 0.6.
    const double variance = std::pow(0.1 * mean_truncation / 0.3, 2) / n;
    const double error =
        std::hypot(2 * std::sqrt(square * variance), 1.5 * variance) / std::sqrt(width * height);
    EXPECT_NEAR(statistics.truncation, square, 4 * error) << passes;
    EXPECT_LT(statistics.truncation_error, 4 * error) << passes;
    EXPECT_GT(statistics.truncation_error, error / 4) << passes;
    EXPECT_NEAR(statistics.blur, 0, 1e-5) << passes;
  }
  // Nothing is known of a truncation that is that of every pass, or of passes too few for pairs.
  for (const int passes : {4, 40}) {
    std::mt19937 random(18);
    PassHistory history(width, height);
    for (int i = 0; i < passes; ++i)
      history.add(truncated_pass(passes == 4 && i % 2 == 0 ? 1.0f : 0.5f, random), {});
    EXPECT_TRUE(std::isnan(bias_statistics(history).truncation)) << passes;
  }
}

TEST(PassHistory, SinglePassesCanBeJoined) {
  std::mt19937 random(2);
  for (const auto& [passes, batches] :
       {std::pair<int, std::size_t>{5, 5}, {6, 3}, {9, 4}, {16, 8}}) {
    PassHistory history(width, height);
    double sum = 0;
    for (int i = 0; i < passes; ++i) {
      const PassImage pass = noisy_pass(1, 0.1, random);
      sum += static_cast<double>(pass.indirect[0].x);
      history.add(pass, {});
    }
    const PassHistory joined = history.with_several_passes_per_batch();
    EXPECT_EQ(joined.batches(), batches);
    double joined_sum = 0, joined_passes = 0;
    for (std::size_t batch = 0; batch < joined.batches(); ++batch) {
      joined_sum += static_cast<double>(joined.sums(batch)[0]);
      joined_passes += joined.passes(batch);
    }
    EXPECT_EQ(joined_passes, passes);
    EXPECT_NEAR(joined_sum, sum, 1e-4);
  }
}

/// A bias that kernels of any width share is seen where it is that of whole regions, though single
/// pixels hide it in the noise of few probes.
TEST(BiasStatistics, SeesABiasOfWholeRegions) {
  std::mt19937 random(15);
  std::normal_distribution<float> noise(0, 1), little_noise(0, 0.01f);
  Film film(width, height);
  for (int i = 0; i < 80; ++i) {
    PassImage pass = noisy_pass(8, 0.1, random);
    std::vector<PixelValue> probes;
    for (std::size_t k = 0; k < film.probe_pixels().size(); ++k) {
      const std::size_t pixel = film.probe_pixels()[k];
      pass.indirect[pixel] += Rgb(0.1f);
      pass.blur.push_back({pixel, Rgb(little_noise(random))});
      if ((k + static_cast<std::size_t>(i)) % 40 == 0)
        probes.push_back({pixel, Rgb(mean + noise(random))});
    }
    film.add(pass, probes);
  }
  const double square = std::pow(0.1 / 1.11, 2);
  const ErrorEstimate estimate = film.error_estimate(false);
  // The standard error of 1,900 probes in four regions is about 0.001.
  EXPECT_NEAR(estimate.bias_mrse, square, 0.003);
  EXPECT_LT(estimate.low, estimate.noise + square);
  EXPECT_GT(estimate.high, estimate.noise + square);
}

/// Beside bright pixels kernels make dark ones three times as bright: they are nine tenths of the
/// error, which the blurred picture's own brightness would hide.
TEST(BiasStatistics, IsRelativeToThePictureWithoutTheBlur) {
  std::mt19937 random(14);
  std::normal_distribution<float> little_noise(0, 0.005f);
  Film film(width, height);
  for (int i = 0; i < 20; ++i) {
    PassImage pass = noisy_pass(8, 0.1, random);
    for (std::size_t k = 0; k < film.probe_pixels().size(); ++k) {
      const std::size_t pixel = film.probe_pixels()[k];
      const bool dark = pixel % 2 == 0;
      pass.indirect[pixel] = pass.indirect[pixel] * (dark ? 0.1f : 1) + Rgb(dark ? 0.2f : -0.2f);
      if (k % 4 < 2)
        pass.blur.push_back({pixel, Rgb((dark ? 0.2f : -0.2f) + little_noise(random))});
    }
    film.add(pass, {});
  }
  const double square = (std::pow(0.2 / 0.11, 2) + std::pow(0.2 / 1.01, 2)) / 2;
  const ErrorEstimate estimate = film.error_estimate(false);
  // What guards the weights against noise makes them smaller; by the blurred picture it would be
  // 0.2.
  EXPECT_NEAR(estimate.bias_mrse, square, 0.35 * square);
}

TEST(ErrorEstimate, IsUnknownBeforeThereIsASpread) {
  std::mt19937 random(5);
  Film film(width, height);
  EXPECT_TRUE(std::isinf(film.error_estimate(true).mrse));
  for (int i = 1; i <= 4; ++i) {
    film.add(noisy_pass(1, 0.1, random));
    const ErrorEstimate estimate = film.error_estimate(false);
    EXPECT_EQ(std::isfinite(estimate.mrse), i > 1);
    EXPECT_EQ(std::isfinite(estimate.low), i > 2);
    EXPECT_TRUE(std::isnan(estimate.bias)) << "nothing was probed";
  }
  // No noise, no error.
  Film constant(width, height);
  PassImage pass;
  pass.resize(width, height);
  for (int i = 0; i < 20; ++i)
    constant.add(pass);
  EXPECT_EQ(constant.error_estimate(true).high, 0);
}

/// The bias from narrower kernels, beside `probes` from path-traced rays.
ErrorEstimate with_blur(double blur, double blur_error, double probes, double probes_error,
                        double hidden_error) {
  const BiasStatistics bias{probes, probes_error, 0, 0.01, blur, blur_error, 0, hidden_error};
  return combine_errors(0.002, {1, 0.1, 16}, bias, false);
}

TEST(ErrorEstimate, RaysThatAreTooFewDoNotOutvoteTheKernels) {
  const ErrorEstimate alone = with_blur(0.002, 0.0004, 0, 1e3, 0);
  EXPECT_NEAR(alone.bias_mrse, 0.00192, 0.00001); // shrunk a little
  // Their errors are ten and three times the signal: the weight of the first is a
  // hundredth, (0.002024 / 0.02)^2, and (0.00192 - 0.01024 * 0.02) / 1.01024 = 0.001698.
  const ErrorEstimate noisy = with_blur(0.002, 0.0004, -0.02, 0.02, 0.006);
  EXPECT_NEAR(noisy.bias_mrse, 0.001698, 0.000002);
  EXPECT_GT(noisy.high, alone.high + 0.003);
  // Those that know better do.
  const ErrorEstimate exact = with_blur(0.002, 0.0004, 0.004, 0.0001, 0);
  EXPECT_NEAR(exact.bias_mrse, 0.004, 0.0001);
}

TEST(ErrorEstimate, FewBatchesThatAgreeByChanceMakeNoBias) {
  // 0.004 +- 0.001 that kernels of any width share: 0.004 less 2 (0.001 t / 1.96)^2 / 0.004, with
  // t = 4.30 and 2.13 for 2 and 15 degrees of freedom, the first is known to 3 %.
  const BiasStatistics bias{0, 1e3, 0, 0.01, 0, 0.0004, 0.004, 0.001};
  EXPECT_NEAR(combine_errors(0.002, {1, 0.1, 3}, bias, false).bias_mrse, 0.0016, 0.00015);
  EXPECT_NEAR(combine_errors(0.002, {1, 0.1, 16}, bias, false).bias_mrse, 0.0034, 0.00005);
}

TEST(ErrorEstimate, TruncationDoesNotOutvoteRaysThatFindMore) {
  const auto with_truncation = [](double hidden, double hidden_error, double truncation) {
    const BiasStatistics bias{0, 1e3, 0, 0.01, 0, 0.0004, hidden, hidden_error, truncation, 2e-4};
    return combine_errors(0.002, {1, 0.1, 16}, bias, false);
  };
  // 0.006 less 2 (0.00102 t / 1.96)^2 / 0.006 with t = 2.13, though the weighted mean is 0.0002.
  const ErrorEstimate found = with_truncation(0.006, 0.001, 0);
  EXPECT_NEAR(found.bias_mrse, 0.0056, 0.00005);
  EXPECT_GT(found.high - found.mrse, 2.13 * 0.00102);
  // Where the rays' own error explains the difference, the weighted mean counts, shrunk a little.
  EXPECT_NEAR(with_truncation(0.003, 0.002, 0.001).bias_mrse, 0.00093, 0.00002);
}

/// What nobody has seen is expected to be no larger than the error that is known, 0.0039, so the
/// interval ends at t = 2.13 times as much above it, and what is known is not sure either.
TEST(ErrorEstimate, RaysThatTellNothingLeaveTheIntervalFinite) {
  const ErrorEstimate blind = with_blur(0.002, 0.0004, 0, 1e3, 1e3);
  EXPECT_NEAR(blind.high, 0.0039 + 2.13 * std::hypot(0.0039, 0.00202), 0.0004);
  // Significant rays count more than the expectation.
  EXPECT_LT(with_blur(0.002, 0.0004, 0, 1e3, 0.001).high, blind.high - 0.003);
}

} // namespace
} // namespace vdbeam
