#include "photonmap/photon_order.h"

#include "math/affine.h"

#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <array>
#include <functional>
#include <numeric>

namespace vdbeam {
namespace {

constexpr std::size_t block_width = 16;
constexpr std::size_t parallel_size = 8192;
/// Below this a comparing selection beats counting.
constexpr std::size_t counting_size = 96;
constexpr std::size_t most_bins = 512;
/// Photons of a run that one thread counts and moves.
constexpr std::size_t chunk_size = 16384;

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

/// Photons `begin` to `end` of a run.
struct Chunk {
  const OrderedPhoton *begin, *end;
};

Chunk chunk_of(const Run& run, std::size_t index) {
  return {run.from + index * chunk_size, run.from + std::min((index + 1) * chunk_size, run.count)};
}

Boxf bound_photons(const Chunk& chunk, Boxf box) {
  for (const OrderedPhoton* photon = chunk.begin; photon != chunk.end; ++photon)
    box.extend(photon->position);
  return box;
}

Boxf bound_run(const Run& run) {
  if (run.count <= chunk_size)
    return bound_photons({run.from, run.from + run.count}, {});
  return tbb::parallel_reduce(
      tbb::blocked_range<const OrderedPhoton*>(run.from, run.from + run.count, chunk_size), Boxf(),
      [](const tbb::blocked_range<const OrderedPhoton*>& range, const Boxf& box) {
        return bound_photons({range.begin(), range.end()}, box);
      },
      [](Boxf a, const Boxf& b) {
        a.extend(b);
        return a;
      });
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

/// Bins of equal width along an axis.
template <int axis>
struct Bins {
  float lower = 0, scale = 0;
  std::int32_t last = 0;

  std::int32_t of(const OrderedPhoton& photon) const {
    return std::min(static_cast<std::int32_t>((coordinate<axis>(photon) - lower) * scale), last);
  }
};

using BinCounts = std::array<std::uint32_t, most_bins>;

/// Where the next photon of a bin before, in, or behind the middle one goes.
struct Places {
  std::size_t left = 0, centre = 0, right = 0;
};

template <int axis>
void count_photons(const Chunk& chunk, const Bins<axis>& bins, BinCounts& counts) {
  for (const OrderedPhoton* photon = chunk.begin; photon != chunk.end; ++photon)
    ++counts[static_cast<std::size_t>(bins.of(*photon))];
}

template <int axis>
void move_photons(const Chunk& chunk, const Bins<axis>& bins, std::size_t middle_bin, Places places,
                  OrderedPhoton* to) {
  const auto middle = static_cast<std::int32_t>(middle_bin);
  for (const OrderedPhoton* photon = chunk.begin; photon != chunk.end; ++photon) {
    const std::int32_t bin = bins.of(*photon);
    const bool is_left = bin<middle, is_right = bin> middle;
    to[is_left ? places.left : (is_right ? places.right : places.centre)] = *photon;
    places.left += is_left;
    places.right += is_right;
    places.centre += !is_left && !is_right;
  }
}

/// The bin that holds the photon of rank `middle`, and the photons in front of it.
struct MiddleBin {
  std::size_t bin = 0, before = 0, within = 0;

  MiddleBin(const BinCounts& counts, std::size_t middle) {
    while (before + counts[bin] <= middle)
      before += counts[bin++];
    within = counts[bin];
  }
  Places first_places() const { return {0, before, before + within}; }
};

template <int axis>
MiddleBin move_to_sides(const Run& run, std::size_t middle, const Bins<axis>& bins) {
  const Chunk all{run.from, run.from + run.count};
  BinCounts counts;
  std::fill(counts.begin(), counts.begin() + bins.last + 1, 0u);
  count_photons(all, bins, counts);
  const MiddleBin centre(counts, middle);
  move_photons(all, bins, centre.bin, centre.first_places(), run.to);
  return centre;
}

/// The same by all threads, with the same result: photons of a side keep their order.
template <int axis>
MiddleBin move_to_sides_in_parallel(const Run& run, std::size_t middle, const Bins<axis>& bins) {
  const std::size_t chunks = (run.count + chunk_size - 1) / chunk_size;
  std::vector<BinCounts> counts(chunks);
  tbb::parallel_for(std::size_t(0), chunks,
                    [&](std::size_t i) { count_photons(chunk_of(run, i), bins, counts[i]); });
  BinCounts total{};
  for (const BinCounts& of_chunk : counts)
    std::transform(total.begin(), total.end(), of_chunk.begin(), total.begin(), std::plus<>());
  const MiddleBin centre(total, middle);
  std::vector<Places> places{centre.first_places()};
  for (std::size_t i = 0; i < chunks; ++i) {
    const auto begin = counts[i].begin(), bin = begin + static_cast<std::ptrdiff_t>(centre.bin);
    Places next = places.back();
    next.left += std::accumulate(begin, bin, std::size_t(0));
    next.centre += *bin;
    next.right += std::accumulate(bin + 1, counts[i].end(), std::size_t(0));
    places.push_back(next);
  }
  tbb::parallel_for(std::size_t(0), chunks, [&](std::size_t i) {
    move_photons(chunk_of(run, i), bins, centre.bin, places[i], run.to);
  });
  return centre;
}

/// Moves the run to its other place so that the `middle` photons with the least coordinates come
/// first: counts them in bins, moves each to the side of its bin, and sorts out the middle bin.
template <int axis>
void split_by_counting(const Run& run, std::size_t middle, float lower, float extent) {
  const std::size_t bin_count = std::clamp<std::size_t>(run.count / 8, 16, most_bins);
  const Bins<axis> bins{lower, static_cast<float>(bin_count) / extent,
                        static_cast<std::int32_t>(bin_count - 1)};
  const MiddleBin centre = run.count <= chunk_size ? move_to_sides(run, middle, bins)
                                                   : move_to_sides_in_parallel(run, middle, bins);
  select<axis>(run.to + centre.before, middle - centre.before, centre.within);
}

template <int axis>
void split_run(Run& run, std::size_t middle, const Boxf& box) {
  // A run whose coordinates fall into one bin is sorted by comparisons.
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

void order_photons(UnfilledArray<OrderedPhoton>& photons) {
  UnfilledArray<OrderedPhoton> other(photons.size());
  order_run({photons.data(), other.data(), photons.size(), true});
}

} // namespace vdbeam
