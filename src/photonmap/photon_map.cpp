#include "photonmap/photon_map.h"

#include "machine/stopwatch.h"
#include "photonmap/kernel_radii.h"
#include "photonmap/map_queries.h"
#include "photonmap/photon_blocks.h"
#include "photonmap/photon_order.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <functional>

namespace vdbeam {
namespace {

/// Photons that one thread looks at in a row.
constexpr std::size_t photons_at_once = 4096;

bool finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A position whose distances can be squared.
bool placeable(const Vec3f& p) {
  constexpr float farthest = 1e15f;
  return std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest;
}

UnfilledArray<OrderedPhoton> finite_photons(const PhotonList& photons) {
  const auto usable = [&](std::size_t i) {
    return placeable(photons.position[i]) && finite(photons.power[i]) &&
           (photons.direction.empty() || finite(photons.direction[i]));
  };
  UnfilledArray<OrderedPhoton> ordered(photons.size());
  const bool all = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, photons.size(), photons_at_once), true,
      [&](const tbb::blocked_range<std::size_t>& range, bool so_far) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          ordered[i] = {photons.position[i], static_cast<std::uint32_t>(i)};
          so_far = so_far && usable(i);
        }
        return so_far;
      },
      std::logical_and<>());
  if (!all)
    std::erase_if(ordered, [&](const OrderedPhoton& photon) { return !usable(photon.index); });
  return ordered;
}

PhotonBlocks gather_blocks(const PhotonList& photons, const UnfilledArray<OrderedPhoton>& order,
                           int channels) {
  PhotonBlocks blocks(order.size(), channels, !photons.direction.empty(),
                      !photons.first_flight.empty(), photons.groups);
  const auto fill_block = [&](std::size_t block) {
    const std::size_t begin = block * PhotonBlocks::width;
    const std::size_t count = std::min(PhotonBlocks::width, order.size() - begin);
    float* rows = blocks.row(block, 0);
    const auto put = [&](int field, std::size_t lane, float value) {
      rows[static_cast<std::size_t>(field) * PhotonBlocks::width + lane] = value;
    };
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::uint32_t from = order[begin + lane].index;
      for (int axis = 0; axis < 3; ++axis)
        put(axis, lane, order[begin + lane].position[axis]);
      const bool first_flight = !photons.first_flight.empty() && photons.first_flight[from] != 0;
      for (int c = 0; c < channels; ++c)
        put(PhotonBlocks::power + c, lane,
            first_flight ? -photons.power[from][c] : photons.power[from][c]);
      if (blocks.has_directions())
        for (int axis = 0; axis < 3; ++axis)
          put(blocks.direction_field() + axis, lane, photons.direction[from][axis]);
      if (blocks.groups() > 0)
        put(blocks.group_field(), lane, photons.group[from]);
    }
  };
  tbb::parallel_for(std::size_t(0), blocks.block_count(), fill_block);
  return blocks;
}

/// K_2D(d, r) r^2 at s = d^2 / r^2 < 1 (docs/theory/beam.md, "Kernels").
float disc_kernel(KernelShape shape, float s) {
  switch (shape) {
  case KernelShape::constant:
    return 1 / pi;
  case KernelShape::epanechnikov:
    return 2 / pi * (1 - s);
  case KernelShape::biweight:
    return 3 / pi * (1 - s) * (1 - s);
  }
  return 0;
}

void weigh_photon(PhotonBlocks& blocks, std::size_t photon, const Kernel& kernel) {
  for (int c = 0; c < blocks.channels(); ++c) {
    float& power = blocks.at(photon, PhotonBlocks::power + c);
    power = power * kernel.weight / kernel.share;
  }
}

} // namespace

struct PhotonMap::Data {
  PhotonBlocks blocks;
  BlockTree tree;
  KernelShape shape = KernelShape::biweight;
  MapTimes times;
  float mean_radius = 0;

  /// After radii have changed.
  void refit() {
    tree = build_block_tree(blocks);
    const double sum = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, blocks.count(), photons_at_once), 0.0,
        [&](const tbb::blocked_range<std::size_t>& range, double so_far) {
          for (std::size_t i = range.begin(); i < range.end(); ++i)
            so_far += static_cast<double>(blocks.at(i, PhotonBlocks::radius));
          return so_far;
        },
        std::plus<>());
    mean_radius =
        blocks.count() ? static_cast<float>(sum / static_cast<double>(blocks.count())) : 0;
  }
  MapView view() const { return {blocks, tree, shape, mean_radius}; }
};

PhotonMap::PhotonMap() : data_(std::make_unique<Data>()) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

PhotonMap PhotonMap::build(PhotonList photons, int channels, const RadiusSettings& radii,
                           KernelShape shape) {
  PhotonMap map;
  Data& data = *map.data_;
  data.shape = shape;
  Stopwatch watch;
  UnfilledArray<OrderedPhoton> order = finite_photons(photons);
  order_photons(order);
  data.blocks = gather_blocks(photons, order, channels);
  photons = {}; // its memory is free for what follows
  data.times.order = watch.restart();

  find_kernel_radii(data.blocks, radii);
  data.times.radii = watch.restart();

  data.refit();
  data.times.build = watch.seconds();
  return map;
}

PhotonMap PhotonMap::copy() const {
  PhotonMap map;
  *map.data_ = {data_->blocks.copy(), data_->tree, data_->shape, data_->times, data_->mean_radius};
  return map;
}

void PhotonMap::fit(const KernelFit& fit) {
  PhotonBlocks& blocks = data_->blocks;
  std::atomic<bool> resized = false;
  tbb::parallel_for(std::size_t(0), blocks.count(), [&](std::size_t i) {
    float& radius = blocks.at(i, PhotonBlocks::radius);
    const Kernel kernel = fit(blocks.position(i), radius);
    if (kernel.radius != radius)
      resized.store(true, std::memory_order_relaxed);
    radius = kernel.radius;
    weigh_photon(blocks, i, kernel);
  });
  if (resized)
    data_->refit();
}

PhotonMap PhotonMap::resized(float factor) const {
  PhotonMap resized = copy();
  PhotonBlocks& blocks = resized.data_->blocks;
  tbb::parallel_for(std::size_t(0), blocks.count(),
                    [&](std::size_t i) { blocks.at(i, PhotonBlocks::radius) *= factor; });
  for (auto& level : resized.data_->tree.levels)
    for (BoxGroup& group : level)
      for (float& radius : group.radius)
        radius *= factor;
  const Boxf bounds = resized.data_->tree.bounds;
  resized.data_->tree.bounds.lower -= bounds.size() * std::max(0.0f, factor - 1);
  resized.data_->tree.bounds.upper += bounds.size() * std::max(0.0f, factor - 1);
  resized.data_->mean_radius *= factor;
  return resized;
}

std::size_t PhotonMap::size() const {
  return data_->blocks.count();
}
std::size_t PhotonMap::bytes() const {
  return data_->blocks.bytes() + data_->tree.bytes();
}
std::size_t PhotonMap::build_bytes_per_photon(int channels, bool directions, bool groups) {
  // A group of boxes of the tree's lowest level has 8 blocks; higher levels add a seventh.
  constexpr std::size_t tree = sizeof(BoxGroup) / (8 * PhotonBlocks::width) + 1;
  // The second order is gone before the map comes, which takes as much or more.
  return PhotonList::bytes_per_photon(directions, groups) + sizeof(OrderedPhoton) +
         PhotonBlocks::bytes_per_photon(channels, directions, groups) + tree;
}
int PhotonMap::channels() const {
  return data_->blocks.channels();
}
bool PhotonMap::has_first_flights() const {
  return data_->blocks.has_first_flights();
}
int PhotonMap::groups() const {
  return data_->blocks.groups();
}
bool PhotonMap::has_directions() const {
  return data_->blocks.has_directions();
}
MapTimes PhotonMap::times() const {
  return data_->times;
}
Boxf PhotonMap::bounds() const {
  return data_->tree.bounds;
}
float PhotonMap::mean_radius() const {
  return data_->mean_radius;
}

QueryCounts PhotonMap::query(BeamTile& tile) const {
  return query_tile(data_->view(), tile);
}

QueryCounts PhotonMap::query_ray(const RayProfile& profile, Rgb& radiance,
                                 std::vector<Rgb>* groups) const {
  return vdbeam::query_ray(data_->view(), profile, radiance, nullptr, groups);
}

void PhotonMap::find_on_disc(const Vec3f& point, std::vector<DiscPhoton>& found) const {
  const PhotonBlocks& blocks = data_->blocks;
  std::vector<std::size_t> photons;
  find_around(data_->view(), point, photons);
  found.reserve(photons.size());
  const int from = blocks.direction_field(), step = blocks.channels() > 1 ? 1 : 0;
  for (const std::size_t i : photons) {
    const Vec3f to = point - blocks.position(i);
    const float radius = blocks.at(i, PhotonBlocks::radius), area = radius * radius;
    const float kernel = disc_kernel(data_->shape, std::min(1.0f, dot(to, to) / area)) / area;
    const Rgb power(blocks.at(i, PhotonBlocks::power), blocks.at(i, PhotonBlocks::power + step),
                    blocks.at(i, PhotonBlocks::power + 2 * step));
    found.push_back(
        {blocks.position(i),
         {blocks.at(i, from), blocks.at(i, from + 1), blocks.at(i, from + 2)},
         power * kernel,
         radius,
         blocks.groups() > 0 ? static_cast<int>(blocks.at(i, blocks.group_field())) : -1});
  }
}

QueryCounts PhotonMap::query_point(const Vec3f& point, const Vec3f& direction,
                                   const std::vector<PhaseFunction>& phases, Rgb* in_scattered,
                                   Rgb* first_flight, std::vector<Rgb>* groups) const {
  return vdbeam::query_point(data_->view(), point, direction, phases, in_scattered, first_flight,
                             groups);
}

} // namespace vdbeam
