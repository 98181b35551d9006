#include "math/rng.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

#include <set>

namespace vdbeam {
namespace {

using test::chi_squared_test;

// Images are promised to be the same for the same seed: these numbers, computed apart from the
// generator by arbitrary-precision integers, may never change.
TEST(Rng, GoldenNumbers) {
  Rng a({1, 0, 0}, RngStage::camera, 0), b({7, 3, 2}, RngStage::photon, 123456789);
  const std::uint32_t expected_a[] = {2654389730, 419334879, 811128355},
                      expected_b[] = {1010161812, 406946161, 2446985962};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(a.bits(), expected_a[i]) << i;
    EXPECT_EQ(b.bits(), expected_b[i]) << i;
  }
}

// The 64-bit mix of SplitMix64 is published: the first outputs for state 0 (Vigna's splitmix64.c).
TEST(Rng, MixIsSplitMix64) {
  EXPECT_EQ(mix64(0x9e3779b97f4a7c15ull), 0xe220a8397b1dcdafull);
  EXPECT_EQ(mix64(2 * 0x9e3779b97f4a7c15ull), 0x6e789e6aa1b965f4ull);
}

TEST(Rng, NumbersAreAFunctionOfTheStreamsName) {
  Rng a({1, 2, 3}, RngStage::test, 4), b({1, 2, 3}, RngStage::test, 4);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(a.bits(), b.bits());
}

TEST(Rng, EveryPartOfTheNameMatters) {
  std::set<std::uint64_t> seen;
  int streams = 0;
  const auto add = [&](const RngKey& key, RngStage stage, std::uint64_t index) {
    Rng rng(key, stage, index);
    const std::uint64_t high = rng.bits();
    seen.insert(high << 32 | rng.bits());
    ++streams;
  };
  // Small numbers in swapped places must not meet.
  for (std::uint64_t i = 0; i < 4; ++i)
    for (std::uint64_t j = 0; j < 4; ++j)
      for (std::uint64_t k = 0; k < 4; ++k)
        for (std::uint64_t l = 0; l < 4; ++l)
          for (const RngStage stage : {RngStage::camera, RngStage::photon, RngStage::path})
            add({i, j, k}, stage, l);
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(streams));
}

TEST(Rng, UniformStaysInItsInterval) {
  Rng rng({}, RngStage::test, 1);
  for (int i = 0; i < 200000; ++i) {
    const float u = rng.uniform(), v = rng.uniform_positive();
    EXPECT_TRUE(u >= 0 && u < 1);
    EXPECT_TRUE(v > 0 && v <= 1);
  }
}

TEST(Rng, OneStreamIsUniform) {
  constexpr int bins = 256, samples = 1 << 20;
  std::vector<double> first(bins, 0.0), low(bins, 0.0), expected(bins, double(samples) / bins);
  Rng rng({}, RngStage::test, 2);
  for (int i = 0; i < samples; ++i) {
    const std::uint32_t x = rng.bits();
    first[x >> 24] += 1;
    low[x & 255] += 1;
  }
  EXPECT_GT(chi_squared_test(first, expected), test::family_level(2));
  EXPECT_GT(chi_squared_test(low, expected), test::family_level(2));
}

TEST(Rng, SuccessiveNumbersAreIndependent) {
  constexpr int bins = 32, samples = 1 << 20;
  for (const int lag : {1, 2, 5}) {
    std::vector<double> counts(bins * bins, 0.0),
        expected(bins * bins, double(samples) / (bins * bins));
    Rng rng({}, RngStage::test, 3);
    std::vector<std::uint32_t> history;
    for (int i = 0; i < samples + lag; ++i) {
      history.push_back(rng.bits() >> 27);
      if (i >= lag)
        counts[history[i - lag] * bins + history[i]] += 1;
    }
    EXPECT_GT(chi_squared_test(counts, expected), test::family_level(3)) << lag;
  }
}

// The first numbers of consecutive streams: photon n and photon n + 1, pass p and pass p + 1.
TEST(Rng, NeighbouringStreamsAreIndependent) {
  constexpr int bins = 32, samples = 1 << 19;
  std::vector<double> by_index(bins * bins, 0.0), by_pass(bins * bins, 0.0),
      expected(bins * bins, double(samples) / (bins * bins));
  const auto first = [](std::uint64_t pass, std::uint64_t index) {
    return Rng({1, 0, pass}, RngStage::photon, index).bits() >> 27;
  };
  for (std::uint64_t i = 0; i < samples; ++i) {
    by_index[first(0, 2 * i) * bins + first(0, 2 * i + 1)] += 1;
    by_pass[first(0, i) * bins + first(1, i)] += 1;
  }
  EXPECT_GT(chi_squared_test(by_index, expected), test::family_level(2));
  EXPECT_GT(chi_squared_test(by_pass, expected), test::family_level(2));
}

} // namespace
} // namespace vdbeam
