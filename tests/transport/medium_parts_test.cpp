// How volumes are sorted by size and by extinction.
#include "medium/medium_parts.h"
#include "medium/nests.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

Nests nests(const std::vector<double>& areas) {
  return find_nests(areas);
}

TEST(Nests, HoldWhatIsSmall) {
  EXPECT_EQ(nests({}), Nests());
  EXPECT_EQ(nests({5}), Nests());
  EXPECT_EQ(nests({1, 10}), Nests()); // about equally large
  EXPECT_EQ(nests({1000, 1}), (Nests{{1}}));
  EXPECT_EQ(nests({1, 1000, 2}), (Nests{{0, 2}}));
  EXPECT_EQ(nests({1e6, 1, 1000}), (Nests{{1}, {1, 2}})); // one within the other
}

/// Many small volumes are together as large as one that is wide.
TEST(Nests, CountTheSumOfAreas) {
  std::vector<double> areas(100, 1.0);
  areas.push_back(1000);
  EXPECT_EQ(nests(areas), Nests());
}

TEST(Nests, AreFew) {
  EXPECT_EQ(nests({1, 1e3, 1e6, 1e9, 1e12, 1e15}).size(), 3u);
}

std::vector<std::uint8_t> parts(const std::vector<float>& peaks) {
  return MediumParts(peaks).of;
}

using Numbers = std::vector<std::uint8_t>;

TEST(MediumParts, HaveLikeExtinctions) {
  EXPECT_EQ(parts({}), Numbers());
  EXPECT_EQ(parts({3}), Numbers({0}));
  EXPECT_EQ(parts({10, 60, 20}), Numbers({0, 0, 0}));
  EXPECT_EQ(parts({0.02f, 60}), Numbers({1, 0}));
  EXPECT_EQ(parts({0.02f, 60, 1, 40, 0.1f}), Numbers({2, 0, 1, 0, 2}));
  EXPECT_EQ(parts({0, 1}), Numbers({1, 0}));
}

TEST(MediumParts, AreFew) {
  const MediumParts many(std::vector<float>{1, 1e-2f, 1e-4f, 1e-6f, 1e-8f, 1e-10f});
  EXPECT_EQ(many.count, 4u);
  EXPECT_FALSE(many.single());
  EXPECT_TRUE(MediumParts(std::vector<float>{1, 2}).single());
}

} // namespace
} // namespace vdbeam
