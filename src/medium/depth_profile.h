#pragma once

#include "lights/sky/ray_air.h"
#include "math/opacity.h"
#include "medium/optical_depth.h"

namespace vdbeam {

/// Optical depth along one camera ray: exact at the crossings of lattice planes and inside cubes
/// that are optically thick, linear in between.
/// One value per volume that the ray meets, for its strongest channel, so that overlapping media of
/// different albedo, phase function or colour can be separated. These volumes are numbered from 0
/// in the profile; `volume` has their numbers in the medium.
class DepthProfile {
public:
  /// Integrates to the segment's end or until less than `cutoff` of the light is left in every
  /// channel. Storage is reused from ray to ray.
  /// `air`: between the camera and places on the ray, by which what they send out is dimmed.
  void build(const Medium& medium, const Segment& segment, float cutoff, const RayAir& air = {});

  const RayAir& air() const { return air_; }
  bool empty() const { return t_.size() < 2; }
  std::size_t knots() const { return t_.size(); }
  float t(std::size_t knot) const { return t_[knot]; }
  float front() const { return t_.front(); } ///< where the medium begins
  float back() const { return t_.back(); }   ///< where the profile ends
  /// Volumes that the ray meets.
  std::size_t volume_count() const { return volumes_; }
  /// Number in the medium of volume v of the profile; they ascend.
  std::size_t volume(std::size_t v) const { return met_[v]; }
  const std::vector<std::uint32_t>& met() const { return met_; }
  /// Optical depth of volume v of the profile from the start to a knot.
  float tau(std::size_t knot, std::size_t v = 0) const { return tau_[knot * volumes_ + v]; }
  /// Sum over the volumes, strongest channels.
  float total(std::size_t knot) const {
    float sum = 0;
    for (std::size_t v = 0; v < volumes_; ++v)
      sum += tau(knot, v);
    return sum;
  }
  /// Opacity of the strongest channels; 0 where the profile is empty.
  float opacity() const { return empty() ? 0 : opacity_of(total(knots() - 1)); }
  /// Per-channel optical depth at a knot.
  Rgb channels(const Medium& medium, std::size_t knot) const {
    return channels_of(medium, [&](std::size_t v) { return tau(knot, v); });
  }
  /// Per-channel optical depth at a knot of what the peak took out of the medium, which has one.
  Rgb taken_out(const Medium& medium, std::size_t knot) const {
    return taken_out_of(medium, [&](std::size_t v) { return tau(knot, v); });
  }
  /// The same for optical depths tau(v) of the volumes of the profile.
  template <class Tau>
  Rgb channels_of(const Medium& medium, const Tau& tau) const {
    Rgb sum;
    for (std::size_t v = 0; v < volumes_; ++v)
      sum += medium.volumes[met_[v]].channel_scale * tau(v);
    return sum;
  }
  template <class Tau>
  Rgb taken_out_of(const Medium& medium, const Tau& tau) const {
    Rgb sum;
    for (std::size_t v = 0; v < volumes_; ++v)
      sum += medium.peak->excess[met_[v]] * tau(v);
    return sum;
  }
  /// The same ray in a medium whose volumes have `factors` times the extinction, by their numbers
  /// in the medium.
  DepthProfile scaled(const std::vector<float>& factors) const {
    DepthProfile result = *this;
    for (std::size_t i = 0; i < tau_.size(); ++i)
      result.tau_[i] *= factors[met_[i % volumes_]];
    return result;
  }
  /// Largest optical depth of one piece, weighted with what is seen of it: how fine a resampling
  /// has to be.
  float sharpest_piece() const;
  /// Integral of Tr sigma_t t dt, mean over channels: opacity times the mean distance of what
  /// makes the medium opaque.
  float opacity_depth(const Medium& medium) const;

private:
  void build_single(const Volume& volume, const Segment& segment, float limit);
  void build_several(const Medium& medium, const Segment& segment, float limit);

  void read_at_knots(const DepthProfile& part, const Volume& volume, const Ray& ray, std::size_t v);

  std::size_t volumes_ = 1;
  std::vector<std::uint32_t> met_;
  std::vector<float> t_, tau_;
  RayAir air_;
};

/// Where in a piece of optical depth `tau`, from 0 to 1, its collisions lie on average: the mean of
/// an exponential distribution cut at 1.
inline float mean_collision(float tau) {
  return tau < 0.25f ? 0.5f - tau / 12 + tau * tau * tau / 720 : 1 / tau + 1 - 1 / opacity_of(tau);
}

/// Reads a profile at increasing distances.
class ProfileCursor {
public:
  explicit ProfileCursor(const DepthProfile& profile) : profile_(&profile) {}

  /// Optical depth of volume v of the profile at the place of the last `move_to`.
  float tau(std::size_t v = 0) const {
    const float a = profile_->tau(knot_, v);
    return a + fraction_ * (profile_->tau(knot_ + 1, v) - a);
  }
  /// The same per channel, of all volumes.
  Rgb channels(const Medium& medium) const {
    return profile_->channels_of(medium, [this](std::size_t v) { return tau(v); });
  }
  /// And of what the peak took out of the medium, which has one.
  Rgb taken_out(const Medium& medium) const {
    return profile_->taken_out_of(medium, [this](std::size_t v) { return tau(v); });
  }
  /// Goes to distance t, not less than before; outside the profile its ends hold.
  void move_to(float t) {
    while (knot_ + 2 < profile_->knots() && profile_->t(knot_ + 1) < t)
      ++knot_;
    const float a = profile_->t(knot_), b = profile_->t(knot_ + 1);
    fraction_ = b > a ? std::clamp((t - a) / (b - a), 0.0f, 1.0f) : 0.0f;
  }

private:
  const DepthProfile* profile_;
  std::size_t knot_ = 0;
  float fraction_ = 0;
};

} // namespace vdbeam
