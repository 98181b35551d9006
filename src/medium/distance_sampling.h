#pragma once

#include "medium/depth_profile.h"

#include <optional>

namespace vdbeam {

/// A scattering point drawn along a ray.
struct ScatterPoint {
  float t = 0;
  float pdf = 0; ///< density of t, over the channels' choice too
  Vec3f position;
  /// Per volume of the profile: sigma_s(t) Tr(0, t) / pdf(t), unbiased, Tr with the profile's air.
  /// Their sum's mean over draws is the integral of sigma_s Tr along the ray.
  const std::vector<Rgb>* weights = nullptr;
  const std::vector<std::uint32_t>* volumes = nullptr; ///< their numbers in the medium
};

/// Draws distances in proportion to what scatters, from a ray's depth profile: forced scattering,
/// no draw leaves the medium. The profile is linear between lattice planes, the true optical depth
/// is not; the weight makes up for the difference, exactly.
class DistanceSampler {
public:
  /// The arguments must outlive the sampler. Requires a profile that is not empty.
  DistanceSampler(const Medium& medium, const Ray& ray, const DepthProfile& profile)
      : medium_(medium), ray_(ray), profile_(profile),
        end_(profile.channels(medium, profile.knots() - 1)), weights_(profile.volume_count()) {}

  /// 1 - Tr of the whole ray in channel c.
  float opacity(int c) const { return opacity_of(end_[c]); }

  /// A point drawn from channel c's distribution, where c was chosen with equal chance if the
  /// medium is chromatic and is 0 otherwise. It lies where that channel's extinction is not 0, also
  /// for u = 1, to which stratified numbers round. Requires u in [0, 1] and opacity(c) > 0.
  ScatterPoint sample(float u, int c);

  /// The point at distance t, inside the profile, with the weights and the density that `sample`
  /// would give it: to combine it with other ways to draw.
  ScatterPoint at(float t);

private:
  float channel_tau(std::size_t knot, int c) const;
  ScatterPoint weigh(std::size_t knot, float t);

  const Medium& medium_;
  const Ray& ray_;
  const DepthProfile& profile_;
  Rgb end_;
  std::vector<Rgb> weights_;
};

/// A volume that scatters at a point, and what it weighs.
struct VolumeChoice {
  std::size_t volume = 0; ///< its number in the medium
  Rgb weight;
};

/// One of the volumes that scatter at the point, drawn by u in [0, 1) in proportion to its share;
/// none where nothing scatters.
std::optional<VolumeChoice> choose_volume(const ScatterPoint& point, float u);

} // namespace vdbeam
