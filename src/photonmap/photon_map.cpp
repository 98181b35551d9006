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

bool stopped(const StopToken* stop) {
  return stop && stop->stopped();
}

UnfilledArray<OrderedPhoton> finite_photons(const PhotonList& photons, std::size_t part) {
  const auto usable = [&](std::size_t i) {
    return (photons.part.empty() ? 0 : photons.part[i]) == part && placeable(photons.position[i]) &&
           finite(photons.power[i]) && (photons.direction.empty() || finite(photons.direction[i]));
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
  /// The photons of a part of the medium.
  struct Part {
    PhotonBlocks blocks;
    BlockTree tree;
    float mean_radius = 0;

    Part copy() const { return {blocks.copy(), tree, mean_radius}; }
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
  };

  std::vector<Part> parts{1};
  KernelShape shape = KernelShape::biweight;
  MapTimes times;

  MapView view(std::size_t part) const {
    const Part& of = parts[part];
    return {of.blocks, of.tree, shape, of.mean_radius};
  }
  /// All parts hold the same fields.
  const PhotonBlocks& blocks() const { return parts[0].blocks; }
};

PhotonMap::PhotonMap() : data_(std::make_unique<Data>()) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

PhotonMap PhotonMap::build(PhotonList photons, int channels, const RadiusSettings& radii,
                           KernelShape shape, const StopToken* stop) {
  PhotonMap map;
  Data& data = *map.data_;
  data.shape = shape;
  Stopwatch watch;
  if (!photons.part.empty())
    data.parts.resize(std::size_t{1} + *std::max_element(photons.part.begin(), photons.part.end()));
  for (std::size_t i = 0; i < data.parts.size(); ++i) {
    UnfilledArray<OrderedPhoton> order = finite_photons(photons, i);
    if (stopped(stop))
      return {};
    order_photons(order);
    if (stopped(stop))
      return {};
    data.parts[i].blocks = gather_blocks(photons, order, channels);
  }
  photons = {}; // its memory is free for what follows
  data.times.order = watch.restart();

  for (Data::Part& part : data.parts)
    if (!stopped(stop))
      find_kernel_radii(part.blocks, radii);
  if (stopped(stop))
    return {};
  data.times.radii = watch.restart();

  for (Data::Part& part : data.parts)
    part.refit();
  data.times.build = watch.seconds();
  return map;
}

PhotonMap PhotonMap::copy() const {
  PhotonMap map;
  map.data_->parts.clear();
  for (const Data::Part& part : data_->parts)
    map.data_->parts.push_back(part.copy());
  map.data_->shape = data_->shape;
  map.data_->times = data_->times;
  return map;
}

void PhotonMap::fit(const KernelFit& fit, const StopToken* stop) {
  for (std::size_t part = 0; part < data_->parts.size(); ++part) {
    PhotonBlocks& blocks = data_->parts[part].blocks;
    std::atomic<bool> resized = false;
    const auto fit_photon = [&](std::size_t i) {
      float& radius = blocks.at(i, PhotonBlocks::radius);
      const Kernel kernel = fit(blocks.position(i), part, radius);
      if (kernel.radius != radius)
        resized.store(true, std::memory_order_relaxed);
      radius = kernel.radius;
      weigh_photon(blocks, i, kernel);
    };
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks.count(), photons_at_once),
        [&](const tbb::blocked_range<std::size_t>& range) {
          if (stopped(stop))
            return;
          for (std::size_t i = range.begin(); i < range.end(); ++i)
            fit_photon(i);
        },
        tbb::simple_partitioner());
    if (resized)
      data_->parts[part].refit();
  }
}

PhotonMap PhotonMap::resized(float factor) const {
  PhotonMap resized = copy();
  for (Data::Part& part : resized.data_->parts) {
    tbb::parallel_for(std::size_t(0), part.blocks.count(),
                      [&](std::size_t i) { part.blocks.at(i, PhotonBlocks::radius) *= factor; });
    for (auto& level : part.tree.levels)
      for (BoxGroup& group : level)
        for (float& radius : group.radius)
          radius *= factor;
    const Boxf bounds = part.tree.bounds;
    part.tree.bounds.lower -= bounds.size() * std::max(0.0f, factor - 1);
    part.tree.bounds.upper += bounds.size() * std::max(0.0f, factor - 1);
    part.mean_radius *= factor;
  }
  return resized;
}

std::size_t PhotonMap::size() const {
  std::size_t sum = 0;
  for (const Data::Part& part : data_->parts)
    sum += part.blocks.count();
  return sum;
}
std::size_t PhotonMap::bytes() const {
  std::size_t sum = 0;
  for (const Data::Part& part : data_->parts)
    sum += part.blocks.bytes() + part.tree.bytes();
  return sum;
}
std::size_t PhotonMap::build_bytes_per_photon(int channels, bool directions, bool groups) {
  // A group of boxes of the tree's lowest level has 8 blocks; higher levels add a seventh.
  constexpr std::size_t tree = sizeof(BoxGroup) / (8 * PhotonBlocks::width) + 1;
  // The second order is gone before the map comes, which takes as much or more.
  return PhotonList::bytes_per_photon(directions, groups) + sizeof(OrderedPhoton) +
         PhotonBlocks::bytes_per_photon(channels, directions, groups) + tree;
}
int PhotonMap::channels() const {
  return data_->blocks().channels();
}
bool PhotonMap::has_first_flights() const {
  return data_->blocks().has_first_flights();
}
int PhotonMap::groups() const {
  return data_->blocks().groups();
}
bool PhotonMap::has_directions() const {
  return data_->blocks().has_directions();
}
MapTimes PhotonMap::times() const {
  return data_->times;
}
Boxf PhotonMap::bounds() const {
  if (data_->parts.size() == 1)
    return data_->parts[0].tree.bounds;
  Boxf all;
  for (const Data::Part& part : data_->parts)
    if (part.blocks.count() > 0)
      all.extend(part.tree.bounds);
  return all;
}
float PhotonMap::mean_radius() const {
  if (data_->parts.size() == 1)
    return data_->parts[0].mean_radius;
  double sum = 0;
  for (const Data::Part& part : data_->parts)
    sum += static_cast<double>(part.mean_radius) * static_cast<double>(part.blocks.count());
  return size() > 0 ? static_cast<float>(sum / static_cast<double>(size())) : 0;
}
float PhotonMap::mean_radius(std::size_t part) const {
  return part < data_->parts.size() ? data_->parts[part].mean_radius : 0;
}

QueryCounts PhotonMap::query(BeamTile& tile) const {
  tile.group_radiance.clear();
  QueryCounts counts;
  for (std::size_t part = 0; part < data_->parts.size(); ++part) {
    tile.choose_part(part);
    counts += query_tile(data_->view(part), tile);
  }
  return counts;
}

QueryCounts PhotonMap::query_ray(std::span<const RayProfile> by_part, Rgb& radiance,
                                 std::vector<Rgb>* groups) const {
  QueryCounts counts;
  std::vector<Rgb> of_part;
  if (groups)
    groups->assign(static_cast<std::size_t>(this->groups()), {});
  for (std::size_t part = 0; part < std::min(by_part.size(), data_->parts.size()); ++part) {
    counts += vdbeam::query_ray(data_->view(part), by_part[part], radiance, nullptr,
                                groups ? &of_part : nullptr);
    for (std::size_t g = 0; g < of_part.size(); ++g)
      (*groups)[g] += of_part[g];
  }
  return counts;
}

void PhotonMap::find_on_disc(const Vec3f& point, std::vector<DiscPhoton>& found) const {
  const PhotonBlocks& blocks = data_->blocks(); // those on surfaces are of one part
  std::vector<std::size_t> photons;
  find_around(data_->view(0), point, photons);
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

QueryCounts PhotonMap::query_point(const Vec3f& point, const Vec3f& direction, std::size_t part,
                                   const std::vector<PhaseFunction>& phases, Rgb* in_scattered,
                                   Rgb* first_flight, std::vector<Rgb>* groups) const {
  if (part < data_->parts.size())
    return vdbeam::query_point(data_->view(part), point, direction, phases, in_scattered,
                               first_flight, groups);
  std::fill_n(in_scattered, phases.size(), Rgb());
  if (first_flight)
    std::fill_n(first_flight, phases.size(), Rgb());
  if (groups)
    groups->assign(static_cast<std::size_t>(this->groups()) * phases.size(), {});
  return {};
}

} // namespace vdbeam
