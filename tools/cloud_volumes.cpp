#include "cloud_volumes.h"

#include "cloud_puffs.h"
#include "leaf_filler.h"

#include <algorithm>
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
      : form_(form), seed_(static_cast<std::uint32_t>(seed * 97)),
        octaves_(std::clamp(static_cast<int>(std::log2(form.detail / voxel)), 1, 4)) {}

  float margin() const { return 0.9f * form_.detail; }

  float at(const Vec3f& p, const std::vector<std::uint32_t>& near) const {
    const float size = form_.detail;
    const Vec3f bend(gradient_noise(p / (2.5f * size), seed_),
                     gradient_noise(p / (2.5f * size), seed_ + 1),
                     gradient_noise(p / (2.5f * size), seed_ + 2));
    const Vec3f bent = p + bend * (0.3f * size);
    float distance = signed_distance(form_, near, bent);
    if (distance > 0.6f * size)
      return 0;
    const float wisps = wispiness(p);
    if (distance > -1.4f * size - form_.wispy)
      distance -= billows(bent) * size * (1 - 0.5f * wisps);
    distance = std::max(distance, form_.base - p.y() + 0.25f * size * (bend.x() + 0.6f));
    return finish(p, distance, wisps);
  }

private:
  /// 0 where the border is sharp, 1 where it frays: near the base and in the anvil, and in places.
  float wispiness(const Vec3f& p) const {
    const float rise = (p.y() - form_.base) / form_.detail;
    const float places = smooth_step(0.1f, 0.6f, gradient_noise(p / (4 * form_.detail), seed_ + 7));
    return std::max({0.8f * (1 - smooth_step(0, 2.5f, rise)), 0.6f * places,
                     smooth_step(form_.fraying, form_.fraying * 1.04f, p.y())});
  }

  /// Displacement of the surface, about -0.4 to 0.5 details.
  float billows(const Vec3f& p) const {
    float sum = -0.35f, strength = 0.55f;
    Vec3f q = p / form_.detail;
    for (int i = 0; i < octaves_; ++i) {
      sum += strength * (billow_noise(q, seed_ + 31 + static_cast<std::uint32_t>(i)) - 0.25f);
      q *= 2.1f;
      strength *= 0.5f;
    }
    return sum;
  }

  float finish(const Vec3f& p, float distance, float wisps) const {
    const float border = form_.crisp + (form_.wispy - form_.crisp) * wisps;
    const float depth = -distance / border;
    if (depth <= 0)
      return 0;
    // Streaks, longer across than high, that eat into a frayed border but not into the core.
    const Vec3f streaked = p * (1 / form_.detail);
    const Vec3f wide(streaked.x() * 1.2f, streaked.y() * 3, streaked.z() * 1.2f);
    const float eaten = (0.25f + 0.75f * wisps) *
                        (0.5f + 0.7f * fractal_noise(wide, octaves_ + 1, seed_ + 63)) /
                        (1 + 0.6f * depth * depth);
    const float solid = smooth_step(0, 1, std::clamp(depth - eaten, 0.0f, 1.0f));
    const float uneven = 0.8f + 0.2f * fractal_noise(streaked * 0.7f, 3, seed_ + 91);
    return std::min(solid * uneven * (1 - 0.35f * wisps), 1.0f);
  }

  const CloudForm& form_;
  std::uint32_t seed_;
  int octaves_;
};

FloatGrid::Ptr make_cloud(const VolumeOptions& options, const CloudForm& form) {
  const float voxel = voxel_size(options), scale = static_cast<float>(options.density);
  const CloudDensity density(form, voxel, options.seed);
  const Reach reach = find_reach(form, voxel, density.margin());
  return fill_leaves(voxel, reach.leaves, least_part * scale, [&](const Vec3f& p, std::size_t i) {
    return scale * density.at(p, reach.puffs[i]);
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
  return make_cloud(options, cumulus_form(Vec3f(0), width, smallest_puff(options), dice));
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
  for (int cell = 0; cell < 196; ++cell) {
    const float x = (static_cast<float>(cell % 14) + dice.next()) / 14 - 0.5f;
    const float z = (static_cast<float>(cell / 14) + dice.next()) / 14 - 0.5f;
    const float street = gradient_noise(Vec3f(2.2f * x + 0.7f * z, 0.5f, 5 * z - 2 * x),
                                        static_cast<std::uint32_t>(options.seed) + 5);
    const float width = extent * (0.045f + 0.1f * street) * dice.between(0.6f, 1.3f);
    if (width < 0.028f * extent)
      continue;
    const Vec3f middle(0.94f * x * extent, 0, 0.94f * z * extent);
    const CloudForm one = cumulus_form(middle, width, 3 * voxel_size(options), dice);
    all.puffs.insert(all.puffs.end(), one.puffs.begin(), one.puffs.end());
  }
  all.detail = 0.0032f * extent;
  all.crisp = 0.0014f * extent;
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
