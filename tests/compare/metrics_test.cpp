#include "compare/flip.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace vdbeam {
namespace {

using Colour = std::array<float, 3>;

Image make_image(int width, int height, const std::function<Colour(int, int)>& colour) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, {}});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Colour value = colour(x, y);
      for (std::size_t c = 0; c < 3; ++c)
        image.channels[c].data.push_back(value[c]);
    }
  return image;
}

Image constant(Colour colour, int width = 64, int height = 48) {
  return make_image(width, height, [&](int, int) { return colour; });
}

TEST(ImageError, MatchesDefinitionsByHand) {
  const Image reference = constant({1, 0, 0.5f}, 2, 1), image = constant({1.1f, 0.1f, 0.5f}, 2, 1);
  const ImageError error = image_error(image, reference);
  EXPECT_NEAR(error.rmse, std::sqrt(0.02 / 3), 1e-7);
  EXPECT_NEAR(error.mrse, (0.01 / (1.01 * 1.01) + 0.01 / (0.01 * 0.01)) / 3, 1e-4);
  EXPECT_NEAR(error.relmse, (0.01 / 1.01 + 0.01 / 0.01) / 3, 1e-6);
  EXPECT_NEAR(error.bias, 1.7 / 1.5 - 1, 1e-6);
  EXPECT_EQ(error.flip, 0) << "only compare_images computes FLIP";
}

TEST(ImageError, TwoReferencesTakeTheirNoiseOut) {
  // A truth of 1, a picture 0.05 off with noise of 0.1, references with noise of 0.03 (one pixel
  // weighs by their mean) and of 0.5 (by the mean around it).
  std::mt19937 random(3);
  for (const float noise : {0.03f, 0.5f}) {
    std::normal_distribution<float> off(0, noise), own(0.05f, 0.1f);
    const auto draw = [&](std::normal_distribution<float>& spread) {
      return make_image(256, 256, [&](int, int) {
        return Colour{1 + spread(random), 1 + spread(random), 1 + spread(random)};
      });
    };
    const Image image = draw(own), a = draw(off), b = draw(off);
    const double mrse = (0.1 * 0.1 + 0.05 * 0.05) / (1.01 * 1.01);
    const double count = 3 * 256 * 256;
    // 4 standard errors of a product of two deviations; the weight is off by its own noise.
    const double spread = static_cast<double>(noise) + 0.1;
    const ImageError error = image_error(image, a, b);
    EXPECT_NEAR(error.mrse, mrse, 4 * spread * spread / std::sqrt(count) + 0.03 * mrse) << noise;
    EXPECT_NEAR(error.bias, 0.05, 4 * spread / std::sqrt(count));
    EXPECT_GT(image_error(image, a).mrse, mrse + 0.8 * noise * noise);
  }
}

TEST(ImageError, TwoReferencesTellHowCertainTheErrorIs) {
  // The noise of pixels side by side is the same, in pairs.
  std::mt19937 random(4);
  std::normal_distribution<float> spread(0, 0.2f);
  const auto draw = [&] {
    Colour last{};
    return make_image(33, 30, [&](int x, int) {
      if (x % 2 == 0)
        last = Colour{1 + spread(random), 1 + spread(random), 1 + spread(random)};
      return last;
    });
  };
  constexpr int draws = 400;
  double sum = 0, squares = 0, stated = 0;
  for (int i = 0; i < draws; ++i) {
    const Image image = draw(), a = draw(), b = draw();
    const ImageError error = image_error(image, a, b);
    sum += error.mrse / draws;
    squares += error.mrse * error.mrse / draws;
    stated += error.mrse_error * error.mrse_error / draws;
  }
  // 4 standard errors of a variance from `draws` draws.
  EXPECT_NEAR(stated / (squares - sum * sum), 1, 4 * std::sqrt(2.0 / draws));
}

TEST(TemporalError, MatchesItsDefinitionByHand) {
  const Image r0 = constant({1, 0, 0.5f}, 2, 1), r1 = constant({3, 0, 0.5f}, 2, 1);
  const Image v0 = constant({1.5f, 0, 0.5f}, 2, 1), v1 = constant({3.1f, 0.1f, 0.5f}, 2, 1);
  EXPECT_NEAR(temporal_error(v0, v1, r0, r1), (0.16 / (2.01 * 2.01) + 0.01 / (0.01 * 0.01)) / 3,
              1e-4);
}

TEST(TemporalError, AnErrorThatStaysIsNoFlicker) {
  const Image r0 = constant({1, 1, 1}), r1 = constant({2, 2, 2});
  const Image v0 = constant({1.5f, 1.5f, 1.5f}), v1 = constant({2.5f, 2.5f, 2.5f});
  EXPECT_EQ(temporal_error(v0, v1, r0, r1), 0);
  EXPECT_GT(image_error(v0, r0).mrse, 0.1);
}

TEST(TemporalError, IndependentNoiseHasTwiceItsMrse) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(1, 0.1f);
  const auto noisy = [&] {
    return make_image(64, 48, [&](int, int) { return Colour{noise(random), noise(random), 1}; });
  };
  const Image truth = constant({1, 1, 1}), a = noisy(), b = noisy();
  const double expected = image_error(a, truth).mrse + image_error(b, truth).mrse;
  // The sum of n = 6144 products of two noises, against that of n squares: 4 / sqrt(n).
  EXPECT_NEAR(temporal_error(a, b, truth, truth) / expected, 1, 0.05);
}

TEST(TemporalError, OtherSizesAndMissingChannelsAreRefused) {
  const Image a = constant({1, 1, 1}, 4, 4), b = constant({1, 1, 1}, 4, 5);
  Image grey = a;
  grey.channels.pop_back();
  EXPECT_THROW(temporal_error(a, b, a, b), InputError);
  EXPECT_THROW(temporal_error(a, a, a, b), InputError);
  EXPECT_THROW(temporal_error(a, grey, a, a), InputError);
}

TEST(ImageError, RelmseDropsTheWorstThousandth) {
  const int width = 100, height = 50; // 5 of 5000 pixels
  const auto with_outliers = [&](int outliers) {
    return make_image(width, height, [&](int x, int y) {
      const float value = y == 0 && x < outliers ? 1000.0f : 1.5f;
      return Colour{value, value, value};
    });
  };
  const Image reference = constant({1, 1, 1}, width, height);
  const double plain = 0.25 / 1.01;
  EXPECT_NEAR(image_error(with_outliers(0), reference).relmse, plain, 1e-9);
  EXPECT_NEAR(image_error(with_outliers(5), reference).relmse, plain, 1e-9);
  EXPECT_GT(image_error(with_outliers(6), reference).relmse, 100.0);
}

TEST(ImageError, IdenticalImagesHaveNone) {
  for (const float value : {0.0f, 0.3f, 1e5f}) {
    const ImageError error = compare_images(constant({value, 0, 1}), constant({value, 0, 1}));
    EXPECT_EQ(error.rmse, 0);
    EXPECT_EQ(error.mrse, 0);
    EXPECT_EQ(error.relmse, 0);
    EXPECT_EQ(error.bias, 0);
    EXPECT_EQ(error.flip, 0);
  }
  EXPECT_EQ(image_error(constant({0, 0, 0}), constant({0, 0, 0})).bias, 0);
}

TEST(ImageError, NanCannotPass) {
  Image image = constant({1, 1, 1});
  image.channels[1].data[7] = std::nanf("");
  const ImageError error = image_error(image, constant({1, 1, 1}));
  EXPECT_TRUE(std::isnan(error.mrse));
  EXPECT_TRUE(std::isnan(error.rmse));
}

TEST(ImageError, OtherSizesAndMissingChannelsAreInputErrors) {
  EXPECT_THROW(image_error(constant({1, 1, 1}, 4, 3), constant({1, 1, 1}, 3, 4)), InputError);
  Image image = constant({1, 1, 1});
  image.channels.pop_back();
  EXPECT_THROW(image_error(image, constant({1, 1, 1})), InputError);
  EXPECT_THROW(compare_images(constant({1, 1, 1}), image), InputError);
  EXPECT_THROW(image_error(Image{}, Image{}), InputError);
}

// ---- FLIP ----

Colour pattern(int x, int y) {
  return {static_cast<float>((x * 7 + y * 3) % 32) / 31,
          static_cast<float>((x / 8 + y / 8) % 2) * 0.8f, static_cast<float>(x) / 63};
}

Colour changed_pattern(int x, int y) {
  const Colour p = pattern(x, y);
  return {0.5f * p[0] + 0.25f, x % 16 < 2 ? 1 - p[1] : p[1], static_cast<float>(y) / 47};
}

Colour noisy_pattern(int x, int y) {
  const unsigned hash = static_cast<unsigned>(x * 1973 + y * 9277) * 2654435761u;
  const float noise = 0.2f * (static_cast<float>(hash >> 16 & 255) / 255 - 0.5f);
  Colour p = pattern(x, y);
  for (float& value : p)
    value = std::clamp(value + noise, 0.0f, 1.0f);
  return p;
}

// Expected values: the authors' own C++ implementation, version 1.6 and later
// (github.com/NVlabs/flip), at 67 pixels per degree on the same images. It works in single
// precision, in another order.
constexpr double flip_tolerance = 1e-4;

TEST(Flip, MatchesTheAuthorsImplementationOnPatterns) {
  const Image reference = make_image(64, 48, pattern);
  const Image changed = make_image(64, 48, changed_pattern);
  const Image noisy = make_image(64, 48, noisy_pattern);
  EXPECT_NEAR(mean_flip(changed, reference), 0.6473008, flip_tolerance);
  EXPECT_NEAR(mean_flip(noisy, reference), 0.1144103, flip_tolerance);
  const std::vector<float> map = flip_map(changed, reference);
  EXPECT_NEAR(map[10 * 64 + 10], 0.304017, 10 * flip_tolerance);
  EXPECT_NEAR(map[24 * 64 + 32], 0.386257, 10 * flip_tolerance);
  EXPECT_NEAR(map[0], 0.991564, 10 * flip_tolerance);
  EXPECT_NEAR(map[47 * 64 + 63], 0.172696, 10 * flip_tolerance);
}

TEST(Flip, MatchesTheAuthorsImplementationOnConstants) {
  const auto flip = [](Colour a, Colour b) { return mean_flip(constant(a), constant(b)); };
  EXPECT_NEAR(flip({0, 0, 0}, {1, 1, 1}), 0.9673653, flip_tolerance);
  EXPECT_NEAR(flip({0, 1, 0}, {0, 0, 1}), 1.0, flip_tolerance);
  EXPECT_NEAR(flip({0.5f, 0.5f, 0.5f}, {0.25f, 0.25f, 0.25f}), 0.4519070, flip_tolerance);
  EXPECT_NEAR(flip({1, 0, 0}, {1, 1, 0}), 0.9771328, flip_tolerance);
}

TEST(Flip, IsSymmetricAndGrowsWithNoise) {
  const Image reference = make_image(64, 48, pattern);
  const Image changed = make_image(64, 48, changed_pattern);
  EXPECT_NEAR(mean_flip(changed, reference), mean_flip(reference, changed), 1e-12);
  EXPECT_EQ(compare_images(changed, reference).flip, mean_flip(changed, reference));
  const auto noisy = [](float strength) {
    return make_image(64, 48, [=](int x, int y) {
      const Colour a = pattern(x, y), b = noisy_pattern(x, y);
      return Colour{a[0] + strength * (b[0] - a[0]), a[1] + strength * (b[1] - a[1]),
                    a[2] + strength * (b[2] - a[2])};
    });
  };
  EXPECT_LT(mean_flip(noisy(0.25f), reference), mean_flip(noisy(0.5f), reference));
  EXPECT_LT(mean_flip(noisy(0.5f), reference), mean_flip(noisy(1), reference));
}

TEST(Flip, ClampsToWhatADisplayShows) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(mean_flip(constant({1, 1, 1}), constant({7, infinity, 1})), 0);
  EXPECT_EQ(mean_flip(constant({0, 0, 0}), constant({-1, -infinity, std::nanf("")})), 0);
}

TEST(Flip, ImagesSmallerThanTheFilters) {
  EXPECT_NEAR(mean_flip(constant({0, 0, 0}, 1, 1), constant({1, 1, 1}, 1, 1)), 0.9673653,
              flip_tolerance);
}

} // namespace
} // namespace vdbeam
