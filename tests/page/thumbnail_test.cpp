#include "page/thumbnail.h"

#include "vdbeam/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace vdbeam {
namespace {

Image ramp(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, std::vector<float>(static_cast<std::size_t>(width) * height)});
    std::iota(image.channels.back().data.begin(), image.channels.back().data.end(), 0.0F);
  }
  return image;
}

double mean(const std::vector<float>& plane) {
  return std::accumulate(plane.begin(), plane.end(), 0.0) / static_cast<double>(plane.size());
}

TEST(Thumbnail, KeepsTheMean) {
  const Image large = ramp(701, 333);
  const Image small = thumbnail_of(large, 320);
  EXPECT_EQ(small.width, 320);
  EXPECT_EQ(small.height, 152);
  const double expected = mean(large.channels[0].data);
  EXPECT_NEAR(mean(small.channels[0].data), expected, 1e-5 * expected);
}

TEST(Thumbnail, AveragesWholePixels) {
  const Image small = thumbnail_of(ramp(4, 2), 2);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 1);
  EXPECT_FLOAT_EQ(small.channels[1].data[0], (0 + 1 + 4 + 5) / 4.0F);
  EXPECT_FLOAT_EQ(small.channels[1].data[1], (2 + 3 + 6 + 7) / 4.0F);
}

TEST(Thumbnail, DoesNotEnlarge) {
  const Image image = ramp(5, 3);
  EXPECT_EQ(thumbnail_of(image, 320).channels[2].data, image.channels[2].data);
}

TEST(Thumbnail, TakesOddShapes) {
  const Image wide = thumbnail_of(ramp(3000, 1), 320), tall = thumbnail_of(ramp(1, 3000), 320);
  EXPECT_EQ(wide.width, 320);
  EXPECT_EQ(wide.height, 1);
  EXPECT_EQ(tall.width, 1);
  EXPECT_EQ(tall.height, 320);
}

TEST(Thumbnail, CountsValuesThatAreNotFiniteAsBlack) {
  Image image = ramp(2, 1);
  image.channels[0].data = {std::numeric_limits<float>::quiet_NaN(), 3};
  image.channels[1].data = {std::numeric_limits<float>::infinity(), 3};
  const Image small = thumbnail_of(image, 1);
  EXPECT_FLOAT_EQ(small.channels[0].data[0], 1.5);
  EXPECT_FLOAT_EQ(small.channels[1].data[0], 1.5);
}

TEST(Thumbnail, NeedsColours) {
  Image image = ramp(2, 2);
  image.channels.pop_back();
  EXPECT_THROW(thumbnail_of(image, 320), InputError);
}

} // namespace
} // namespace vdbeam
