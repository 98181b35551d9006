#include "photonmap/photon_order.h"

#include "math/affine.h"

#include <tbb/parallel_invoke.h>

namespace vdbeam {
namespace {

constexpr std::size_t block_width = 16;
constexpr std::size_t parallel_size = 8192;
/// Below this a comparing selection beats counting.
constexpr std::size_t counting_size = 96;
constexpr std::size_t most_bins = 512;

/// A run of photons that lies in `from`; `to` is a second place of the same size, and the one of
/// the two that the ordered run must end in is `from` if `stay`.
struct Run {
  OrderedPhoton* from;
  OrderedPhoton* to;
  std::size_t count;
  bool stay;
};

/// The greatest 16 * 2^l below `count`: where an implicit tree splits a run of photons.
std::size_t split_position(std::size_t count) {
  std::size_t size = block_width;
  while (size * 2 < count)
    size *= 2;
  return size;
}

Boxf bound_run(const Run& run) {
  Boxf box;
  for (std::size_t i = 0; i < run.count; ++i)
    box.extend(run.from[i].position);
  return box;
}

int longest_axis(const Boxf& box) {
  const Vec3f size = box.size();
  if (size.x >= size.y && size.x >= size.z)
    return 0;
  return size.y >= size.z ? 1 : 2;
}

template <int axis>
float coordinate(const OrderedPhoton& photon) {
  if constexpr (axis == 0)
    return photon.position.x;
  else if constexpr (axis == 1)
    return photon.position.y;
  else
    return photon.position.z;
}

template <int axis>
void select(OrderedPhoton* begin, std::size_t middle, std::size_t count) {
  std::nth_element(begin, begin + middle, begin + count,
                   [](const OrderedPhoton& a, const OrderedPhoton& b) {
                     return coordinate<axis>(a) < coordinate<axis>(b);
                   });
}

/// Moves the run to its other place so that the `middle` photons with the least coordinates come
/// first: counts them in bins, moves each to the side of its bin, and sorts out the middle bin.
template <int axis>
void split_by_counting(const Run& run, std::size_t middle, float lower, float extent) {
  const std::size_t bins = std::clamp<std::size_t>(run.count / 8, 16, most_bins);
  const float scale = static_cast<float>(bins) / extent;
  const auto last = static_cast<std::int32_t>(bins - 1);
  const auto bin_of = [&](const OrderedPhoton& photon) {
    return std::min(static_cast<std::int32_t>((coordinate<axis>(photon) - lower) * scale), last);
  };
  std::uint32_t counts[most_bins];
  std::fill(counts, counts + bins, 0u);
  for (std::size_t i = 0; i < run.count; ++i)
    ++counts[bin_of(run.from[i])];
  std::int32_t middle_bin = 0;
  std::size_t before = 0;
  while (before + counts[middle_bin] <= middle)
    before += counts[middle_bin++];
  const std::size_t within = counts[middle_bin];
  std::size_t left = 0, centre = before, right = before + within;
  for (std::size_t i = 0; i < run.count; ++i) {
    const std::int32_t bin = bin_of(run.from[i]);
    const bool is_left = bin<middle_bin, is_right = bin> middle_bin;
    const std::size_t place = is_left ? left : (is_right ? right : centre);
    run.to[place] = run.from[i];
    left += is_left;
    right += is_right;
    centre += !is_left && !is_right;
  }
  select<axis>(run.to + before, middle - before, within);
}

template <int axis>
void split_run(Run& run, std::size_t middle, const Boxf& box) {
  // A run too narrow for its coordinates to be told apart by bins is left to comparisons.
  const float lower = coordinate<axis>({box.lower, 0}), upper = coordinate<axis>({box.upper, 0});
  if (run.count < counting_size || !(upper - lower > 1e-30f)) {
    select<axis>(run.from, middle, run.count);
    return;
  }
  split_by_counting<axis>(run, middle, lower, upper - lower);
  std::swap(run.from, run.to);
  run.stay = !run.stay;
}

void order_run(Run run) {
  const Boxf box = run.count > block_width ? bound_run(run) : Boxf();
  if (run.count <= block_width || box.lower == box.upper) {
    if (!run.stay)
      std::copy(run.from, run.from + run.count, run.to);
    return;
  }
  const std::size_t middle = split_position(run.count);
  const int axis = longest_axis(box);
  if (axis == 0)
    split_run<0>(run, middle, box);
  else if (axis == 1)
    split_run<1>(run, middle, box);
  else
    split_run<2>(run, middle, box);
  const Run low{run.from, run.to, middle, run.stay};
  const Run high{run.from + middle, run.to + middle, run.count - middle, run.stay};
  if (run.count > parallel_size) {
    tbb::parallel_invoke([=] { order_run(low); }, [=] { order_run(high); });
  } else {
    order_run(low);
    order_run(high);
  }
}

} // namespace

void order_photons(std::vector<OrderedPhoton>& photons) {
  std::vector<OrderedPhoton> other(photons.size());
  order_run({photons.data(), other.data(), photons.size(), true});
}

} // namespace vdbeam
