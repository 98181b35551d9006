#pragma once

#include "math/rng.h"
#include "transport/medium.h"

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
  VolumeTracker(const Volume& volume, const Ray& ray, float t_begin, float t_end)
      : volume_(&volume), local_origin_(volume.local_point(ray.origin)),
        local_direction_(volume.local_vector(ray.direction)),
        walk_(local_origin_ * 0.125f, local_direction_ * 0.125f, volume.field.cell_counts(),
              t_begin, t_end),
        t_(walk_.t()) {
    if (!walk_.done())
      enter_cell();
  }

  /// The next tentative collision; t is infinity where the ray leaves first.
  Collision next(Rng& rng) {
    float tau = -std::log(rng.uniform_positive());
    while (!walk_.done()) {
      const float available = majorant_ * (walk_.t_exit() - t_);
      if (tau < available) {
        t_ = std::min(t_ + tau / majorant_, walk_.t_exit());
        return collide();
      }
      tau -= available;
      t_ = walk_.t_exit();
      walk_.advance();
      if (!walk_.done())
        enter_cell();
    }
    return {};
  }

private:
  void enter_cell() {
    const Vec3<int>& c = walk_.cell();
    majorant_ = volume_->extinction * volume_->majorants[volume_->field.cell_offset(c.x, c.y, c.z)];
  }

  Collision collide() const {
    const Vec3<int>& c = walk_.cell();
    const std::int32_t entry = volume_->field.cell(c.x, c.y, c.z);
    float density;
    if (entry >= 0) {
      const Vec3f corner{static_cast<float>(8 * c.x), static_cast<float>(8 * c.y),
                         static_cast<float>(8 * c.z)};
      const Vec3f p = min(max(local_origin_ + local_direction_ * t_ - corner, Vec3f(0)), Vec3f(8));
      density = sample_brick(volume_->field.brick(entry), p.x, p.y, p.z);
    } else {
      density = volume_->field.uniform_value(entry);
    }
    return {t_, std::min(density * volume_->extinction, majorant_), majorant_, volume_};
  }

  const Volume* volume_;
  Vec3f local_origin_, local_direction_;
  CellWalk walk_;
  float t_;
  float majorant_ = 0;
};

/// Tentative collisions of all volumes: independent Poisson processes superpose, so the nearest of
/// the volumes' next collisions is the medium's. Overlapping volumes need no common grid.
/// Requires a medium that is not empty.
class MediumTracker {
public:
  MediumTracker(const Medium& medium, const Ray& ray, float t_begin, float t_end)
      : first_(medium.volumes[0], ray, t_begin, t_end) {
    if (medium.volumes.size() > 1) {
      others_.reserve(medium.volumes.size() - 1);
      for (std::size_t i = 1; i < medium.volumes.size(); ++i)
        others_.emplace_back(medium.volumes[i], ray, t_begin, t_end);
    }
  }

  Collision next(Rng& rng) { return others_.empty() ? first_.next(rng) : next_of_several(rng); }

private:
  Collision next_of_several(Rng& rng) {
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
    return pending_[nearest_];
  }

  VolumeTracker first_;
  std::vector<VolumeTracker> others_;
  std::vector<Collision> pending_;
  std::size_t nearest_ = 0;
};

} // namespace vdbeam
