#include "film/film.h"

#include "support/chi_squared.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>

namespace vdbeam {
namespace {

/// A pass of random values over many orders of magnitude; the same for the same number.
PassImage random_pass(int width, int height, unsigned number) {
  PassImage pass;
  pass.resize(width, height);
  std::mt19937 random(number);
  std::lognormal_distribution<float> radiance(0, 4);
  std::uniform_real_distribution<float> opacity;
  for (std::size_t i = 0; i < pass.opacity.size(); ++i) {
    pass.direct[i] = {radiance(random), radiance(random), radiance(random)};
    pass.indirect[i] = {radiance(random), radiance(random), radiance(random)};
    pass.background[i] = {radiance(random), radiance(random), radiance(random)};
    pass.opacity[i] = opacity(random);
    pass.depth[i] = number % 3 ? radiance(random) : 0;
  }
  return pass;
}

void expect_same_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    const std::vector<float>&x = a.channels[c].data, &y = b.channels[c].data;
    ASSERT_EQ(x.size(), y.size());
    ASSERT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(float)), 0) << a.channels[c].name;
  }
}

/// The medium's own light has sums and an AOV of its own, and counts in all that is shown.
TEST(Film, Emission) {
  PassImage pass;
  pass.resize(2, 1, true);
  pass.direct = {{1, 2, 3}, {}};
  pass.indirect = {{10, 20, 30}, {}};
  pass.background = {{100, 200, 300}, {1, 1, 1}};
  pass.emission = {{0.5f, 0.25f, 0.125f}, {4, 0, INFINITY}};
  PassImage black; // a pass of a frame in which nothing glows
  black.resize(2, 1);
  Film film(2, 1, true);
  film.add(pass);
  film.add(black);
  Film other(2, 1, true);
  other.add(pass);
  other.add(black);
  film.merge(other);
  const Image image = film.develop();
  EXPECT_EQ(image.find("volume_emission.R")->data, (std::vector<float>{0.25f, 2}));
  EXPECT_EQ(image.find("volume_emission.G")->data, (std::vector<float>{0.125f, 0}));
  EXPECT_EQ(image.find("volume.R")->data, (std::vector<float>{5.75f, 2}));
  EXPECT_EQ(image.find("R")->data, (std::vector<float>{55.75f, 2.5f}));
  EXPECT_EQ(film.invalid_values(), 2u);
  EXPECT_GT(film.mrse_estimate(), 0);
  EXPECT_EQ(Film(2, 1).develop().find("volume_emission.R"), nullptr);
  Film none(2, 1);
  EXPECT_THROW(film.merge(none), std::invalid_argument);
  // The planes of a film without, and a double and a float for each channel.
  EXPECT_EQ(film.planes().size(), none.planes().size() + 6);
}

TEST(Film, DevelopsSumsOfOutputs) {
  PassImage pass;
  pass.resize(2, 1);
  pass.direct = {{1, 2, 3}, {}};
  pass.indirect = {{10, 20, 30}, {}};
  pass.background = {{100, 200, 300}, {1, 1, 1}};
  pass.opacity = {0.5f, 0};
  pass.depth = {4, 0};
  Film film(2, 1);
  film.add(pass);
  PassImage black;
  black.resize(2, 1);
  film.add(black);
  EXPECT_EQ(film.passes(), 2);
  const Image image = film.develop();
  EXPECT_EQ(image.find("R")->data, (std::vector<float>{55.5f, 0.5f}));
  EXPECT_EQ(image.find("G")->data[0], 111.0f);
  EXPECT_EQ(image.find("B")->data[0], 166.5f);
  EXPECT_EQ(image.find("A")->data, (std::vector<float>{0.25f, 0}));
  EXPECT_EQ(image.find("volume.G")->data[0], 11.0f);
  EXPECT_EQ(image.find("volume_direct.B")->data[0], 1.5f);
  EXPECT_EQ(image.find("volume_indirect.R")->data[0], 5.0f);
  EXPECT_EQ(image.find("volume.A")->data[0], 0.25f);
  EXPECT_EQ(image.find("depth.Z")->data, (std::vector<float>{8, 1e10f})) << "sum over opacity";
  EXPECT_FALSE(image.find("depth.Z")->half);
  EXPECT_TRUE(image.find("R")->half);
}

TEST(Film, IsBlackBeforeTheFirstPass) {
  const Image image = Film(3, 2).develop();
  EXPECT_EQ(image.channels.size(), 15u);
  for (const ImageChannel& channel : image.channels)
    EXPECT_EQ(channel.data, std::vector<float>(6, channel.name == "depth.Z" ? 1e10f : 0.0f))
        << channel.name;
}

// Blender 3.4 drops other channels ("multilayer read: unknown channel token"); Nuke and OpenImageIO
// take any.
TEST(Film, ChannelsHaveNamesThatBlenderShows) {
  const Image image = Film(1, 1, true).develop();
  for (const ImageChannel& channel : image.channels) {
    const std::size_t dot = channel.name.rfind('.');
    const std::string last = dot == std::string::npos ? channel.name : channel.name.substr(dot + 1);
    EXPECT_EQ(last.size(), 1u) << channel.name;
    EXPECT_NE(std::string("RGBAXYZVU").find(last), std::string::npos) << channel.name;
  }
}

TEST(Film, ManyPassesOfAConstantGiveTheConstant) {
  PassImage pass;
  pass.resize(1, 1);
  pass.direct[0] = {0.1f, 1e-12f, 12345.678f};
  pass.opacity[0] = 0.7f;
  Film film(1, 1);
  for (int i = 0; i < 100000; ++i)
    film.add(pass);
  const Image image = film.develop();
  // The sums are exact, so the means are too: stronger than 1e-7.
  EXPECT_EQ(image.find("R")->data[0], 0.1f);
  EXPECT_EQ(image.find("G")->data[0], 1e-12f);
  EXPECT_EQ(image.find("B")->data[0], 12345.678f);
  EXPECT_EQ(image.find("A")->data[0], 0.7f);
  EXPECT_LT(film.mrse_estimate(), 1e-14);
}

TEST(Film, SmallValuesSurviveLargeOnes) {
  // 2^40 and back: a double sum alone would lose 2^-30.
  PassImage pass;
  pass.resize(1, 1);
  Film film(1, 1);
  for (const float value : {0x1p40f, 0x1p-30f, -0x1p40f, 0x1p-30f}) {
    pass.direct[0] = {value, 0, 0};
    film.add(pass);
  }
  EXPECT_EQ(film.develop().find("R")->data[0], 0x1p-31f);
}

TEST(Film, AnyGroupingOfPassesGivesTheSameBits) {
  const int passes = 60;
  const auto film_of = [&](const std::vector<int>& numbers) {
    Film film(17, 5);
    for (const int number : numbers)
      film.add(random_pass(17, 5, static_cast<unsigned>(number)));
    return film;
  };
  std::vector<int> order(passes);
  for (int i = 0; i < passes; ++i)
    order[static_cast<std::size_t>(i)] = i;
  const Image whole = film_of(order).develop();

  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    Film merged(17, 5);
    for (auto begin = order.begin(); begin != order.end();) {
      const auto left = static_cast<unsigned>(order.end() - begin);
      const auto end = begin + 1 + random() % left;
      merged.merge(film_of({begin, end}));
      begin = end;
    }
    ASSERT_EQ(merged.passes(), passes);
    expect_same_bits(merged.develop(), whole);
  }
}

TEST(Film, ThreadsDoNotChangeBits) {
  const auto develop = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Film film(150, 100);
    for (unsigned i = 0; i < 4; ++i)
      film.add(random_pass(150, 100, i));
    return std::pair(film.develop(), film.mrse_estimate());
  };
  const auto one = develop(1), two = develop(2);
  expect_same_bits(one.first, two.first);
  EXPECT_EQ(one.second, two.second);
}

TEST(Film, InvalidValuesAreCountedAndIgnored) {
  Film film(2, 1);
  PassImage pass = random_pass(2, 1, 1);
  film.add(pass);
  const Image before = film.develop();
  PassImage bad;
  bad.resize(2, 1);
  bad.direct[0].x = std::numeric_limits<float>::quiet_NaN();
  bad.background[1].z = std::numeric_limits<float>::infinity();
  bad.depth[0] = -std::numeric_limits<float>::infinity();
  film.add(bad);
  EXPECT_EQ(film.invalid_values(), 3u);
  EXPECT_EQ(film.develop().find("R")->data[0], before.find("R")->data[0] / 2);
  EXPECT_EQ(film.develop().find("depth.Z")->data[0], before.find("depth.Z")->data[0]);
  EXPECT_TRUE(std::isfinite(film.mrse_estimate()));
  Film other(2, 1);
  other.merge(film);
  EXPECT_EQ(other.invalid_values(), 3u);
}

TEST(Film, OtherSizesAreRefused) {
  Film film(2, 3);
  EXPECT_THROW(film.add(random_pass(3, 2, 0)), std::invalid_argument);
  EXPECT_THROW(film.merge(Film(3, 2)), std::invalid_argument);
}

TEST(Film, ErrorEstimateNeedsTwoPasses) {
  Film film(2, 1);
  EXPECT_TRUE(std::isinf(film.mrse_estimate()));
  film.add(random_pass(2, 1, 1));
  EXPECT_TRUE(std::isinf(film.mrse_estimate()));
  film.add(random_pass(2, 1, 2));
  EXPECT_TRUE(std::isfinite(film.mrse_estimate()));
}

TEST(Film, ErrorEstimateMatchesKnownNoise) {
  // Normal noise about a mean so large that dividing by the estimated mean changes nothing that the
  // test can see: (n - 1) s^2 / sigma^2 summed over all values is chi-squared with (n - 1) 3 pixels
  // degrees of freedom; its logarithmic tails at p = 1e-4 are the bounds.
  const float mean = 1000, sigma = 0.5f;
  const int width = 40, height = 25, n = 8;
  std::mt19937 random(99);
  std::normal_distribution<float> noise(0, sigma);
  Film film(width, height);
  PassImage pass;
  pass.resize(width, height);
  for (int p = 0; p < n; ++p) {
    for (std::size_t i = 0; i < pass.opacity.size(); ++i) {
      pass.direct[i] = Rgb(0.5f * mean);
      pass.indirect[i] = Rgb(0.25f * mean);
      pass.background[i] = Rgb{noise(random), noise(random), noise(random)} + Rgb(0.25f * mean);
    }
    film.add(pass);
  }
  const int degrees = (n - 1) * 3 * width * height;
  const double expected = sigma * sigma / (n * (mean + 0.01) * (mean + 0.01));
  const double statistic = film.mrse_estimate() / expected * degrees;
  EXPECT_GT(test::chi_squared_tail(statistic, degrees), 1e-4);
  EXPECT_LT(test::chi_squared_tail(statistic, degrees), 1 - 1e-4);

  // The same in halves, merged: the estimate counts passes, not films.
  Film merged(width, height);
  merged.merge(film);
  EXPECT_EQ(merged.mrse_estimate(), film.mrse_estimate());
}

/// Pages of memory that this process has in use.
long resident_pages() {
  long all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident;
}

/// A film of 4K has 1.4 GB (and arrays that the C library gets from the system): where a frame ends
/// before its first pass, nothing is to wait for them.
TEST(Film, TakesItsMemoryWithItsFirstPass) {
  const long before = resident_pages();
  const Film film(4096, 2304, true, {"key", "fill"}, std::nullopt, {"cloud"}, {"position.X"});
  constexpr long mib = (1 << 20) / 4096;
  EXPECT_LT(resident_pages() - before, 32 * mib);
  EXPECT_EQ(film.passes(), 0);
}

} // namespace
} // namespace vdbeam
