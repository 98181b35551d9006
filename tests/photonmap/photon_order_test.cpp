#include "photonmap/photon_order.h"

#include "math/affine.h"
#include "math/rng.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

namespace vdbeam {
namespace {

using Order = UnfilledArray<OrderedPhoton>;

/// Photons of a long, thin cloud that is denser at one end; `copies` of each.
Order random_photons(std::size_t count, std::size_t copies = 1) {
  Rng rng({}, RngStage::test, 3);
  Order photons;
  while (photons.size() < count) {
    const float along = rng.uniform();
    const Vec3f position{4 * along * along, rng.uniform(), 0.1f * rng.uniform()};
    for (std::size_t i = 0; i < copies && photons.size() < count; ++i)
      photons.push_back({position, static_cast<std::uint32_t>(photons.size())});
  }
  return photons;
}

Boxf bounds(const OrderedPhoton* begin, const OrderedPhoton* end) {
  Boxf box;
  for (; begin != end; ++begin)
    box.extend(begin->position);
  return box;
}

/// Splits that do not halve the longest side of their cell's box.
std::size_t wrong_splits(const OrderedPhoton* begin, std::size_t count) {
  if (count <= 16)
    return 0;
  std::size_t left = 16;
  while (2 * left < count)
    left *= 2;
  const Vec3f size = bounds(begin, begin + count).size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const bool wrong =
      bounds(begin, begin + left).upper[axis] > bounds(begin + left, begin + count).lower[axis];
  return wrong + wrong_splits(begin, left) + wrong_splits(begin + left, count - left);
}

class PhotonOrder : public testing::TestWithParam<std::size_t> {};

TEST_P(PhotonOrder, SplitsEveryCellAcrossItsLongestSide) {
  for (const std::size_t copies : {1, 50}) {
    const Order photons = random_photons(GetParam(), copies);
    Order ordered = photons;
    order_photons(ordered);
    EXPECT_EQ(wrong_splits(ordered.data(), ordered.size()), 0u) << copies;
    std::vector<bool> seen(photons.size());
    for (const OrderedPhoton& photon : ordered) {
      EXPECT_EQ(photon.position, photons[photon.index].position);
      seen[photon.index] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), photons.size());
  }
}

TEST_P(PhotonOrder, DoesNotDependOnThreads) {
  Order alone = random_photons(GetParam(), 3), together = alone;
  tbb::task_arena(1).execute([&] { order_photons(alone); });
  tbb::task_arena(4).execute([&] { order_photons(together); });
  for (std::size_t i = 0; i < alone.size(); ++i)
    ASSERT_EQ(alone[i].index, together[i].index) << i;
}

// One block, cells that one thread orders, and those that several threads split.
INSTANTIATE_TEST_SUITE_P(Counts, PhotonOrder, testing::Values(0, 1, 16, 17, 1000, 16385, 100000));

} // namespace
} // namespace vdbeam
