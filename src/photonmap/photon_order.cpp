#include "photonmap/photon_order.h"

#include "math/affine.h"

#include <tbb/parallel_invoke.h>

namespace vdbeam {
namespace {

constexpr std::size_t block_width = 16;
constexpr std::size_t parallel_size = 8192;

/// The greatest 16 * 2^l below `count`: where an implicit tree splits a run of photons.
std::size_t split_position(std::size_t count) {
  std::size_t size = block_width;
  while (size * 2 < count)
    size *= 2;
  return size;
}

int longest_axis(const OrderedPhoton* begin, const OrderedPhoton* end) {
  Boxf box;
  for (const OrderedPhoton* p = begin; p != end; ++p)
    box.extend(p->position);
  const Vec3f size = box.size();
  if (size.x >= size.y && size.x >= size.z)
    return 0;
  return size.y >= size.z ? 1 : 2;
}

template <int axis>
void partition(OrderedPhoton* begin, OrderedPhoton* middle, OrderedPhoton* end) {
  std::nth_element(begin, middle, end, [](const OrderedPhoton& a, const OrderedPhoton& b) {
    if constexpr (axis == 0)
      return a.position.x < b.position.x;
    else if constexpr (axis == 1)
      return a.position.y < b.position.y;
    else
      return a.position.z < b.position.z;
  });
}

void order_range(OrderedPhoton* begin, OrderedPhoton* end) {
  const std::size_t count = static_cast<std::size_t>(end - begin);
  if (count <= block_width)
    return;
  OrderedPhoton* middle = begin + split_position(count);
  const int axis = longest_axis(begin, end);
  if (axis == 0)
    partition<0>(begin, middle, end);
  else if (axis == 1)
    partition<1>(begin, middle, end);
  else
    partition<2>(begin, middle, end);
  if (count > parallel_size) {
    tbb::parallel_invoke([=] { order_range(begin, middle); }, [=] { order_range(middle, end); });
  } else {
    order_range(begin, middle);
    order_range(middle, end);
  }
}

} // namespace

void order_photons(std::vector<OrderedPhoton>& photons) {
  order_range(photons.data(), photons.data() + photons.size());
}

} // namespace vdbeam
