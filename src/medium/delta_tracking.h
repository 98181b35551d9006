#pragma once

#include "math/rng.h"
#include "medium/medium.h"

namespace vdbeam {

/// A tentative collision of delta tracking, null or real.
struct Collision {
  float t = infinity; ///< distance along the ray
  float sigma_t = 0;  ///< of its volume's strongest channel, at the point
  float majorant = 0; ///< of its volume, at the point: sigma_t <= majorant
  const Volume* volume = nullptr;
};

/// Tentative collisions of one volume along a ray: a Poisson process whose rate is the local
/// majorant (Woodcock et al. 1965, with a majorant per cell).
class VolumeTracker {
public:
  VolumeTracker(const Volume& volume, const Segment& segment)
      : volume_(&volume), local_origin_(volume.local_point(segment.ray.origin)),
        local_direction_(volume.local_vector(segment.ray.direction)),
        walk_(local_origin_ * 0.125f, local_direction_ * 0.125f, volume.field.cell_counts(),
              segment.t_begin, segment.t_end),
        t_(walk_.t()) {
    if (!walk_.done())
      enter_cell();
  }

  /// Advances to the next tentative collision; false where the segment ends first. The density
  /// there is only prefetched: loading it takes longer than everything else, and a caller with
  /// several walks can continue with another one meanwhile.
  bool advance(Rng& rng) {
    float tau = -std::log(rng.uniform_positive());
    while (!walk_.done()) {
      const float available = majorant_ * (walk_.t_exit() - t_);
      if (tau < available) {
        t_ = std::min(t_ + tau / majorant_, walk_.t_exit());
        locate();
        return true;
      }
      tau -= available;
      t_ = walk_.t_exit();
      walk_.advance();
      if (!walk_.done())
        enter_cell();
    }
    return false;
  }

  /// The tentative collision that advance() found.
  Collision collision() const {
    const float density =
        cube_ ? sample_cube(cube_, offset_.x, offset_.y, offset_.z) : uniform_density_;
    return {t_, std::min(density * volume_->extinction, majorant_), majorant_, volume_};
  }

  /// The next tentative collision; t is infinity where the segment ends first.
  Collision next(Rng& rng) { return advance(rng) ? collision() : Collision(); }

private:
  void enter_cell() {
    const Vec3<int>& c = walk_.cell();
    majorant_ = volume_->extinction * volume_->majorants[volume_->field.cell_offset(c.x, c.y, c.z)];
  }

  /// Finds the lattice cube of the point.
  void locate() {
    const Vec3<int>& c = walk_.cell();
    const std::int32_t entry = volume_->field.cell(c.x, c.y, c.z);
    if (entry < 0) {
      cube_ = nullptr;
      uniform_density_ = volume_->field.uniform_value(entry);
      return;
    }
    constexpr int width = brick_width;
    cube_ = volume_->field.brick(entry);
    constexpr int strides[3] = {width * width, width, 1};
    for (int a = 0; a < 3; ++a) {
      const float corner = static_cast<float>(8 * c[a]);
      const float x = std::clamp(local_origin_[a] + local_direction_[a] * t_ - corner, 0.0f, 8.0f);
      const int i = std::min(static_cast<int>(x), 7);
      cube_ += i * strides[a];
      offset_[a] = x - static_cast<float>(i);
    }
    __builtin_prefetch(cube_);
    __builtin_prefetch(cube_ + width + 1);
    __builtin_prefetch(cube_ + width * width);
    __builtin_prefetch(cube_ + width * width + width + 1);
  }

  const Volume* volume_;
  Vec3f local_origin_, local_direction_;
  GridTraversal walk_;
  float t_;
  float majorant_ = 0;
  const float* cube_ =
      nullptr;   ///< lower corner of the point's lattice cube; null in a uniform cell
  Vec3f offset_; ///< of the point in that cube
  float uniform_density_ = 0;
};

/// Tentative collisions of all volumes: independent Poisson processes superpose, so the nearest of
/// the volumes' next collisions is the medium's. Overlapping volumes need no common grid.
/// Requires a medium that is not empty.
class MediumTracker {
public:
  MediumTracker(const Medium& medium, const Segment& segment) : first_(medium.volumes[0], segment) {
    if (medium.volumes.size() < 2)
      return;
    if (!medium.tree)
      others_.reserve(medium.volumes.size() - 1);
    medium.for_each_met(segment, [&](std::size_t v) {
      if (v > 0)
        others_.emplace_back(medium.volumes[v], segment);
    });
  }

  /// As VolumeTracker's.
  bool advance(Rng& rng) { return others_.empty() ? first_.advance(rng) : advance_several(rng); }
  Collision collision() const { return others_.empty() ? first_.collision() : pending_[nearest_]; }
  Collision next(Rng& rng) { return advance(rng) ? collision() : Collision(); }

private:
  bool advance_several(Rng& rng) {
    if (pending_.empty()) {
      pending_.push_back(first_.next(rng));
      for (VolumeTracker& other : others_)
        pending_.push_back(other.next(rng));
    } else {
      pending_[nearest_] = nearest_ == 0 ? first_.next(rng) : others_[nearest_ - 1].next(rng);
    }
    nearest_ = 0;
    for (std::size_t i = 1; i < pending_.size(); ++i)
      if (pending_[i].t < pending_[nearest_].t)
        nearest_ = i;
    return pending_[nearest_].volume != nullptr;
  }

  VolumeTracker first_;
  std::vector<VolumeTracker> others_;
  std::vector<Collision> pending_;
  std::size_t nearest_ = 0;
};

} // namespace vdbeam
