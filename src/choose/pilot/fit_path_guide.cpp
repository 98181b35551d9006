#include "choose/pilot/fit_path_guide.h"

#include "choose/pilot/trial_tile.h"
#include "photons/view_thinning.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>

namespace vdbeam {

namespace {

/// Sums over the blocks of a lattice: of what is measured, and of what it is measured by.
struct BlockSums {
  Vec3<int> counts;
  std::vector<double> value, measure, visits;

  explicit BlockSums(const Vec3<int>& n)
      : counts(n), value(static_cast<std::size_t>(n.x) * n.y * n.z), measure(value.size()),
        visits(value.size()) {}

  void add(std::size_t block, double v, double m) {
    value[block] += v;
    measure[block] += m;
    ++visits[block];
  }
};

/// The ratio of value to measure, block by block. Where visits are few it leans on the ratio over
/// the 2 x 2 x 2 blocks around, and so on upwards; where there are none at all it is `unknown`.
std::vector<double> ratios(const BlockSums& sums, double unknown) {
  const Vec3<int>& n = sums.counts;
  if (sums.value.size() == 1)
    return {sums.measure[0] > 0 ? sums.value[0] / sums.measure[0] : unknown};
  BlockSums coarse({(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2});
  const auto for_each_block = [&](const auto& visit) {
    std::size_t block = 0;
    for (int x = 0; x < n.x; ++x)
      for (int y = 0; y < n.y; ++y)
        for (int z = 0; z < n.z; ++z, ++block)
          visit(block,
                (static_cast<std::size_t>(x / 2) * coarse.counts.y + y / 2) * coarse.counts.z +
                    z / 2);
  };
  double measure = 0, visits = 0;
  for_each_block([&](std::size_t block, std::size_t parent) {
    coarse.value[parent] += sums.value[block];
    coarse.measure[parent] += sums.measure[block];
    coarse.visits[parent] += sums.visits[block];
    measure += sums.measure[block];
    visits += sums.visits[block];
  });
  const double prior = visits > 0 ? tuning::guide_prior_visits * measure / visits : 0;
  const std::vector<double> around = ratios(coarse, unknown);
  std::vector<double> result(sums.value.size());
  for_each_block([&](std::size_t block, std::size_t parent) {
    const double m = sums.measure[block] + prior;
    result[block] = m > 0 ? (sums.value[block] + prior * around[parent]) / m : 0;
  });
  return result;
}

/// The same over the blocks of all lattices.
class MediumSums {
public:
  explicit MediumSums(const MediumBlocks& blocks) : blocks_(blocks) {
    for (std::size_t i = 0; i < blocks.lattices(); ++i)
      sums_.emplace_back(blocks.counts(i));
  }

  void add(std::size_t block, double value, double measure) {
    std::size_t lattice = blocks_.lattices() - 1;
    while (block < blocks_.first(lattice))
      --lattice;
    sums_[lattice].add(block - blocks_.first(lattice), value, measure);
  }
  BlockSums& operator[](std::size_t lattice) { return sums_[lattice]; }

  /// Nests that were not visited have the mean of the medium around them.
  std::vector<double> ratios() const {
    double value = 0, measure = 0;
    for (const double v : sums_.back().value)
      value += v;
    for (const double m : sums_.back().measure)
      measure += m;
    std::vector<double> result;
    for (const BlockSums& lattice : sums_) {
      const std::vector<double> part = vdbeam::ratios(lattice, measure > 0 ? value / measure : 0);
      result.insert(result.end(), part.begin(), part.end());
    }
    return result;
  }

private:
  const MediumBlocks& blocks_;
  std::vector<BlockSums> sums_;
};

/// The pilot's photons, and where they lie.
class Pilot {
public:
  Pilot(const World& world, const TracedPhotons& traced, const CellTables& view)
      : medium_(world.medium), photons_(traced.photons), blocks_(world.medium) {
    block_of_.reserve(photons_.size());
    for (const Vec3f& position : photons_.position)
      block_of_.push_back(blocks_.at(position));
    weigh(view_importance_at(world, view, photons_));
  }

  const MediumBlocks& blocks() const { return blocks_; }

  /// Contribution of paths after they met a block, per unit of flux. Leaves in `brought`, by path
  /// and 0 at first, what all of its photons bring.
  std::vector<double> importance(const Rgb& albedo, std::vector<double>& brought) const {
    MediumSums sums(blocks_);
    const double unit = 1 / max_component(Vec3d(albedo)); // stored powers hold it, paths do not
    for (std::size_t i = photons_.size(); i-- > 0;) {
      double& later = brought[photons_.path[i]];
      sums.add(block_of_[i], later, unit * max_component(Vec3d(photons_.power[i])) * majorant(i));
      later += values_[i];
    }
    return sums.ratios();
  }

private:
  double power(std::size_t photon) const { return mean_component(Vec3d(photons_.power[photon])); }
  std::size_t part(std::size_t photon) const {
    return photons_.part.empty() ? 0 : photons_.part[photon];
  }
  double majorant(std::size_t photon) const {
    return static_cast<double>(medium_.majorant(photons_.position[photon], part(photon)));
  }
  bool has_medium(const Vec3f& point) const {
    for (std::size_t part = 0; part < medium_.parts.count; ++part)
      if (medium_.majorant(point, part) > 0)
        return true;
    return false;
  }

  /// Mean fluence where there is medium, by block and up to a factor.
  std::vector<double> fluence() const {
    MediumSums sums(blocks_);
    for (std::size_t i = 0; i < photons_.size(); ++i)
      sums.add(block_of_[i], power(i), 0);
    for (std::size_t lattice = 0; lattice < blocks_.lattices(); ++lattice) {
      const Vec3<int>& n = blocks_.counts(lattice);
      const double volume = volume_of_block(lattice);
      tbb::parallel_for(0, n.x, [&](int x) {
        for (int y = 0; y < n.y; ++y)
          for (int z = 0; z < n.z; ++z) {
            const std::size_t block = (static_cast<std::size_t>(x) * n.y + y) * n.z + z;
            sums[lattice].measure[block] = volume * filled(lattice, {x, y, z}, block);
          }
      });
    }
    return sums.ratios();
  }

  /// Mean extinction of each part of the medium where light is, up to a factor.
  std::vector<double> mean_extinctions() const {
    std::vector<double> flux(medium_.parts.count), powers(flux.size());
    for (std::size_t i = 0; i < photons_.size(); ++i) {
      flux[part(i)] += power(i) * majorant(i);
      powers[part(i)] += power(i);
    }
    for (std::size_t p = 0; p < flux.size(); ++p)
      flux[p] = medium_.parts.single() || !(powers[p] > 0) ? 1 : flux[p] / powers[p];
    return flux;
  }

  /// Volume of a lattice's block over that of the medium's lattice.
  double volume_of_block(std::size_t lattice) const {
    const auto volume = [&](std::size_t of) {
      const Vec3f edges =
          blocks_.point(of, {1, 1, 1}, Vec3f(0)) - blocks_.point(of, {0, 0, 0}, Vec3f(0));
      return static_cast<double>(edges.x) * static_cast<double>(edges.y) *
             static_cast<double>(edges.z);
    };
    const double whole = volume(blocks_.lattices() - 1);
    return whole > 0 ? volume(lattice) / whole : 1;
  }

  /// Part of a block in which there is medium, by its cells, and no smaller lattice.
  double filled(std::size_t lattice, const Vec3<int>& at, std::size_t block) const {
    constexpr int across = 3;
    int count = 0;
    for (int i = 0; i < across * across * across; ++i) {
      const Vec3<int> part{i / (across * across), i / across % across, i % across};
      const Vec3f point = blocks_.point(lattice, at, (Vec3f(part) + Vec3f(0.5f)) / across);
      count += blocks_.at(point) == blocks_.first(lattice) + block && has_medium(point);
    }
    return static_cast<double>(count) / (across * across * across);
  }

  void weigh(const std::vector<float>& view) {
    const std::vector<double> around = fluence(), extinction = mean_extinctions();
    double light = 0, space = 0;
    values_.resize(photons_.size());
    for (std::size_t i = 0; i < photons_.size(); ++i) {
      values_[i] = power(i) * extinction[part(i)] * static_cast<double>(view[i]);
      light += values_[i];
      space += around[block_of_[i]] > 0 ? values_[i] / around[block_of_[i]] : 0;
    }
    const double dark = space > 0 ? tuning::dark_offset * light / space : 0;
    for (std::size_t i = 0; i < photons_.size(); ++i)
      values_[i] = values_[i] > 0 ? values_[i] / (around[block_of_[i]] + dark) : 0;
  }

  const Medium& medium_;
  const PhotonList& photons_;
  MediumBlocks blocks_;
  std::vector<std::size_t> block_of_; ///< each photon
  std::vector<double> values_;        ///< what each photon brings
};

/// Cumulative distribution over the steps of a light whose paths brought this, in the order of
/// their places.
std::vector<double> emission_distribution(const double* brought, std::size_t paths) {
  std::vector<double> sum(PathGuide::steps), count(PathGuide::steps);
  double all = 0;
  for (std::size_t i = 0; i < paths; ++i) {
    const std::size_t step = i * PathGuide::steps / paths;
    sum[step] += brought[i];
    ++count[step];
    all += brought[i];
  }
  const double mean = paths > 0 ? all / static_cast<double>(paths) : 0;
  double total = 0;
  for (std::size_t s = 0; s < sum.size(); ++s)
    total += sum[s] =
        (sum[s] + tuning::guide_prior_paths * mean) / (count[s] + tuning::guide_prior_paths);
  std::vector<double> cumulative{0};
  for (const double value : sum)
    cumulative.push_back(cumulative.back() +
                         (total > 0 ? (1 - tuning::guide_uniform_share) * value / total
                                    : 1 - tuning::guide_uniform_share) +
                         tuning::guide_uniform_share / PathGuide::steps);
  for (double& value : cumulative)
    value /= cumulative.back();
  return cumulative;
}

void fit_lights(const World& world, const std::vector<std::uint64_t>& first,
                const std::vector<double>& brought, PathGuide& guide) {
  double power = 0;
  std::vector<double> sums, powers;
  for (std::size_t l = 0; l + 1 < first.size(); ++l) {
    const double* of_light = brought.data() + first[l];
    const std::uint64_t paths = first[l + 1] - first[l];
    guide.distribution.push_back(emission_distribution(of_light, paths));
    sums.push_back(0);
    for (std::uint64_t i = 0; i < paths; ++i)
      sums.back() += of_light[i];
    guide.total += sums.back();
    powers.push_back(mean_component(Vec3d(world.lights[l].power())));
    power += powers.back();
  }
  for (std::size_t l = 0; l < sums.size(); ++l)
    guide.light_shares.push_back((1 - tuning::guide_power_share) * sums[l] / guide.total +
                                 tuning::guide_power_share * powers[l] / power);
}

} // namespace

std::shared_ptr<const PathGuide> fit_path_guide(const EstimatorInput& input, PhotonPlan& plan,
                                                const CellTables& view, double mean_collisions) {
  const World& world = input.world;
  PhotonPassSettings pass = pass_settings(input, plan, guide_pass);
  const double wanted =
      std::clamp(tuning::guide_share * static_cast<double>(choose_paths(input.settings, plan)),
                 tuning::fewest_guide_paths, tuning::most_guide_paths);
  pass.paths = static_cast<std::uint64_t>(
      std::ceil(std::min(wanted, tuning::most_guide_photons / std::max(1.0, mean_collisions))));
  pass.store_probability = 1;
  pass.store_probability_by_cell = nullptr;
  pass.directions = false;
  pass.path_numbers = true;
  const TracedPhotons traced = trace_photons(world, pass);
  plan.pilot_paths += pass.paths;
  if (traced.photons.size() < tuning::fewest_guide_photons)
    return nullptr;
  const std::vector<std::uint64_t> first = share_paths(world.lights, pass.paths, nullptr);
  const Pilot pilot(world, traced, view);
  auto guide = std::make_shared<PathGuide>(pilot.blocks());
  std::vector<double> brought(first.back());
  const std::vector<double> importance = pilot.importance(pass.albedo, brought);
  guide->importance.assign(importance.begin(), importance.end());
  fit_lights(world, first, brought, *guide);
  return guide->total > 0 ? guide : nullptr;
}

} // namespace vdbeam
