#include "cloud_volumes.h"

#include "cloud_puffs.h"
#include "leaf_filler.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace vdbeam {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3f;

float voxel_size(const VolumeOptions& options) {
  return static_cast<float>(options.extent / options.size);
}

/// The puffs that reach each leaf of a cloud.
struct Reach {
  std::vector<Coord> leaves;
  std::vector<std::vector<std::uint32_t>> puffs;
};

/// `margin` is how far beyond its radius a puff may have cloud.
Reach find_reach(const CloudForm& form, float voxel, float margin) {
  Reach reach;
  std::unordered_map<std::uint64_t, std::size_t> places;
  const float leaf = 8 * voxel;
  for (std::uint32_t i = 0; i < form.puffs.size(); ++i) {
    const Puff& puff = form.puffs[i];
    const float across = puff.radius + margin, up = puff.radius * puff.flatness + margin;
    const auto cell = [leaf](float x) { return static_cast<int>(std::floor(x / leaf)); };
    const Vec3f half(across, up, across);
    const Vec3f low = puff.centre - half, high = puff.centre + half;
    for (int x = cell(low.x()); x <= cell(high.x()); ++x)
      for (int y = std::max(cell(low.y()), cell(form.base)); y <= cell(high.y()); ++y)
        for (int z = cell(low.z()); z <= cell(high.z()); ++z) {
          const auto bits = [](int c) { return static_cast<std::uint64_t>(c + (1 << 20)); };
          const auto [place, added] =
              places.try_emplace(bits(x) << 42 | bits(y) << 21 | bits(z), reach.leaves.size());
          if (added) {
            reach.leaves.emplace_back(8 * x, 8 * y, 8 * z);
            reach.puffs.emplace_back();
          }
          reach.puffs[place->second].push_back(i);
        }
  }
  return reach;
}

/// Distance to the surface of the puffs, below 0 inside; creases between puffs are rounded.
float signed_distance(const CloudForm& form, const std::vector<std::uint32_t>& near,
                      const Vec3f& p) {
  float distance = 1e30f;
  for (const std::uint32_t i : near) {
    const Puff& puff = form.puffs[i];
    Vec3f to = p - puff.centre;
    to.y() /= puff.flatness;
    const float d = (to.length() - puff.radius) * (puff.flatness < 1 ? 0.6f : 1.0f);
    const float rounding = 0.12f * puff.radius * puff.flatness;
    const float overlap = std::max(rounding - std::abs(d - distance), 0.0f) / rounding;
    distance = std::min(d, distance) - 0.25f * overlap * overlap * rounding;
  }
  return distance;
}

/// Density of a cloud in [0, 1], from coarse to fine: balls, billows, a border that frays.
class CloudDensity {
public:
  CloudDensity(const CloudForm& form, float voxel, std::uint64_t seed)
      : form_(form), voxel_(voxel), seed_(static_cast<std::uint32_t>(seed * 97)),
        crisp_(std::max(form.crisp, 1.2f * voxel)), wispy_(std::max(form.wispy, 2 * crisp_)),
        octaves_(std::clamp(static_cast<int>(std::log2(form.detail / voxel)) + 1, 1, 7)) {}

  /// Distance beyond a puff's radius at which there may be cloud.
  float margin() const { return (bend_ + most_out_) * form_.detail; }

  /// Distance below the surface of the puffs beyond which the density is `core`.
  float core_depth() const { return most_in_ * form_.detail + 3 * wispy_; }

  /// Low frequencies of the noise at the corners of a leaf, between which they are interpolated.
  struct Corners {
    Coord leaf;
    std::array<Vec3f, 8> bend;
    std::array<float, 8> places;
  };

  Corners corners(const Coord& leaf) const {
    Corners found{leaf, {}, {}};
    for (int i = 0; i < 8; ++i) {
      const Coord corner = leaf + Coord(8 * (i & 1), 8 * ((i >> 1) & 1), 8 * (i >> 2));
      const Vec3f p = corner.asVec3s() * voxel_;
      found.bend[static_cast<std::size_t>(i)] = turbulence(p / (2.2f * form_.detail), 2, seed_);
      found.places[static_cast<std::size_t>(i)] =
          smooth_step(0.2f, 0.7f, gradient_noise(p / (3.1f * form_.detail), seed_ + 7));
    }
    return found;
  }

  /// Leaves out the puffs that cannot touch a leaf's density; true if all of the leaf is core.
  bool cull(const Coord& leaf, std::vector<std::uint32_t>& near) const {
    const Vec3f middle = (leaf.asVec3s() + Vec3f(3.5f)) * voxel_;
    const float slack = 6.1f * voxel_ + bend_ * form_.detail;
    const float base = middle.y() - form_.base - slack;
    if (base > core_depth() && signed_distance(form_, near, middle) + slack < -core_depth())
      return true;
    float nearest = 1e30f;
    std::vector<float> distances(near.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Puff& puff = form_.puffs[near[i]];
      distances[i] = puff.flatness < 1 ? -1e30f : (middle - puff.centre).length() - puff.radius;
      if (puff.flatness == 1)
        nearest = std::min(nearest, distances[i] + slack);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
      if (distances[i] - slack < nearest + 0.12f * form_.puffs[near[i]].radius)
        near[kept++] = near[i];
    near.resize(kept);
    return false;
  }

  float at(const Vec3f& p, const std::vector<std::uint32_t>& near, const Corners& corners) const {
    const float size = form_.detail;
    Vec3f bend(0);
    float places = 0;
    const Vec3f t = (p / voxel_ - corners.leaf.asVec3s()) / 8;
    for (std::size_t i = 0; i < 8; ++i) {
      const float weight =
          (i & 1 ? t.x() : 1 - t.x()) * (i & 2 ? t.y() : 1 - t.y()) * (i & 4 ? t.z() : 1 - t.z());
      bend += weight * corners.bend[i];
      places += weight * corners.places[i];
    }
    const Vec3f bent = p + bend * (bend_ * size);
    const float balls = signed_distance(form_, near, bent);
    if (balls > most_out_ * size)
      return 0;
    const float wisps = wispiness(p, places);
    const float base = form_.base - p.y() + 0.12f * size * (bend.x() + 0.8f);
    const float distance = std::max(billowed(bent, balls, wisps), base);
    return finish(p, distance, wisps);
  }

  static constexpr float core = 0.85f;

private:
  /// Three values of fractal noise, each about -1 to 1.
  static Vec3f turbulence(const Vec3f& p, int octaves, std::uint32_t seed) {
    return {fractal_noise(p, octaves, seed), fractal_noise(p, octaves, seed + 211),
            fractal_noise(p, octaves, seed + 421)};
  }

  /// 0 where the border is sharp, 1 where it frays: near the base and in the anvil, and in places.
  float wispiness(const Vec3f& p, float places) const {
    const float rise = (p.y() - form_.base) / form_.detail;
    const float across = std::hypot(p.x() - form_.tower.x(), p.z() - form_.tower.z());
    const float anvil = smooth_step(form_.fraying, form_.fraying * 1.05f, p.y()) *
                        smooth_step(0.8f, 1.25f, across / std::max(form_.tower_radius, 1e-6f));
    return std::max({0.7f * (1 - smooth_step(0, 1.2f, rise)), 0.55f * places, anvil});
  }

  /// The distance after displacement by bumps of many sizes. A bump carries small ones on its
  /// crown; the creases between bumps stay smooth.
  float billowed(const Vec3f& p, float distance, float wisps) const {
    Vec3f q = p / form_.detail;
    float strength = 0.62f * form_.detail * (1 - 0.7f * wisps), left = 2.3f * strength;
    for (int i = 0; i < octaves_; ++i) {
      // Beyond `left` no further octave can change whether there is cloud, or core.
      if (distance > left || distance < -left - 3 * wispy_)
        break;
      const float bump = billow_noise(q, seed_ + 31 + static_cast<std::uint32_t>(i));
      distance -= strength * (bump - 0.62f);
      const float next = 0.56f * strength * (0.5f + 0.8f * bump) * (1 - 0.35f * wisps);
      left = 2.3f * next;
      strength = next;
      // Turned, so that the lattices of the octaves do not coincide.
      q = Vec3f(0.8f * q.x() + 0.6f * q.z(), q.y(), 0.8f * q.z() - 0.6f * q.x()) * 2.07f +
          Vec3f(1.3f, 4.1f, 2.7f);
    }
    return distance;
  }

  float finish(const Vec3f& p, float distance, float wisps) const {
    const float border = crisp_ + (wispy_ - crisp_) * wisps;
    const float depth = -distance / border;
    if (depth <= 0)
      return 0;
    const float deep = smooth_step(1, 3, -distance / wispy_);
    if (deep >= 1)
      return core;
    // Shreds that turbulence draws out eat into a frayed border but not into the core.
    const Vec3f q = p * (1 / form_.detail);
    float eaten = 0;
    if (wisps > 0.02f && depth < 3) {
      const Vec3f swirl = turbulence(q * 1.6f, 2, seed_ + 130);
      const Vec3f streaked(q.x() * 1.3f, q.y() * 2.2f, q.z() * 1.3f);
      eaten = wisps *
              (0.75f + 1.1f * fractal_noise(streaked + swirl * 0.9f, octaves_, seed_ + 63)) /
              (1 + 0.5f * depth * depth);
    }
    const float solid = smooth_step(0, 1, std::clamp(depth - std::max(eaten, 0.0f), 0.0f, 1.0f));
    const float uneven = 0.8f + 0.25f * fractal_noise(q * 0.9f, 2, seed_ + 91);
    const float density = solid * uneven * (1 - 0.45f * wisps);
    return std::clamp(density + (core - density) * deep, 0.0f, 1.0f);
  }

  // Lengths in details: of the bending of space, and of the billows outwards and inwards.
  static constexpr float bend_ = 0.3f, most_out_ = 0.55f, most_in_ = 0.8f;

  const CloudForm& form_;
  float voxel_;
  std::uint32_t seed_;
  float crisp_, wispy_; ///< not less than voxels can show
  int octaves_;
};

FloatGrid::Ptr make_cloud(const VolumeOptions& options, const CloudForm& form) {
  const float voxel = voxel_size(options), scale = static_cast<float>(options.density);
  const CloudDensity density(form, voxel, options.seed);
  Reach reach = find_reach(form, voxel, density.margin());
  std::vector<char> core(reach.leaves.size());
  std::vector<CloudDensity::Corners> corners(core.size());
  tbb::parallel_for(std::size_t{0}, core.size(), [&](std::size_t i) {
    core[i] = density.cull(reach.leaves[i], reach.puffs[i]);
    if (!core[i])
      corners[i] = density.corners(reach.leaves[i]);
  });
  return fill_leaves(voxel, reach.leaves, least_part * scale, [&](const Vec3f& p, std::size_t i) {
    return scale * (core[i] ? CloudDensity::core : density.at(p, reach.puffs[i], corners[i]));
  });
}

/// Least radius of a puff: smaller ones are left to the noise.
float smallest_puff(const VolumeOptions& options) {
  return std::max(5 * voxel_size(options), 0.01f * static_cast<float>(options.extent));
}

} // namespace

FloatGrid::Ptr cumulus(const VolumeOptions& options) {
  Dice dice(options.seed);
  const auto width = static_cast<float>(0.8 * options.extent);
  return make_cloud(options, cumulus_form(Vec3f(0), width, 1, smallest_puff(options), dice));
}

FloatGrid::Ptr storm(const VolumeOptions& options) {
  Dice dice(options.seed);
  return make_cloud(options,
                    storm_form(static_cast<float>(options.extent), smallest_puff(options), dice));
}

FloatGrid::Ptr cumulus_field(const VolumeOptions& options) {
  Dice dice(options.seed);
  const auto extent = static_cast<float>(options.extent);
  CloudForm all;
  for (int cell = 0; cell < 324; ++cell) {
    const float x = (static_cast<float>(cell % 18) + dice.next()) / 18 - 0.5f;
    const float z = (static_cast<float>(cell / 18) + dice.next()) / 18 - 0.5f;
    const float street = gradient_noise(Vec3f(2.2f * x + 0.7f * z, 0.5f, 5 * z - 2 * x),
                                        static_cast<std::uint32_t>(options.seed) + 5);
    const float width = extent * (0.036f + 0.075f * street) * dice.between(0.5f, 1.4f);
    if (width < 0.014f * extent)
      continue;
    const float tallness = dice.between(0.45f, 0.8f);
    const Vec3f middle(0.92f * x * extent, 0, 0.92f * z * extent);
    const CloudForm one = cumulus_form(middle, width, tallness, 5 * voxel_size(options), dice);
    all.puffs.insert(all.puffs.end(), one.puffs.begin(), one.puffs.end());
  }
  all.detail = 0.0075f * extent;
  all.crisp = 0.0008f * extent;
  all.wispy = 0.0045f * extent;
  all.fraying = 1e30f;
  return make_cloud(options, all);
}

FloatGrid::Ptr fog_bank(const VolumeOptions& options) {
  const auto extent = static_cast<float>(options.extent),
             scale = static_cast<float>(options.density);
  const float voxel = voxel_size(options), half = 0.5f * extent, height = 0.055f * extent;
  const auto seed = static_cast<std::uint32_t>(options.seed * 97);
  std::vector<Coord> leaves;
  const int across = std::max(options.size / 16, 1), up = std::max(options.size / 80, 1);
  for (int x = -across; x < across; ++x)
    for (int z = -across; z < across; ++z)
      for (int y = 0; y <= up; ++y)
        leaves.emplace_back(8 * x, 8 * y, 8 * z);
  return fill_leaves(voxel, leaves, least_part * scale, [=](const Vec3f& p, std::size_t) {
    const Vec3f q = p / extent;
    const Vec3f rolling(q.x() * 5, q.y() * 14, q.z() * 7);
    const float top = height * (1 + 0.55f * fractal_noise(Vec3f(q.x() * 3, 0, q.z() * 4), 2, seed) +
                                0.5f * fractal_noise(rolling, 5, seed + 11));
    const float side = std::max(std::abs(p.x()), std::abs(p.z()));
    const float border = 1 - smooth_step(0.85f * half, half, side);
    const float solid = 1 - smooth_step(0.35f * top, 1.5f * top, p.y());
    const float patches = 0.75f + 0.6f * fractal_noise(rolling * 2.0f, 4, seed + 23);
    return scale * std::clamp(solid * border * patches, 0.0f, 1.0f);
  });
}

} // namespace vdbeam
