#pragma once

#include "grids/moved_field.h"
#include "volume/density_field.h"

#include <algorithm>

namespace vdbeam {

/// By how much a velocity moves the points of a density grid, in local coordinates of the density.
class Displacement {
public:
  /// Steps of the fixed point x = p + time v(p) at most: its error falls with (time |grad v|)^n.
  /// Ended where a step changes less than a hundredth of a voxel.
  static constexpr int fixed_point_steps = 5;
  static constexpr double near_enough = 0.01;

  Displacement(const DensityGrid& grid, const Motion& motion) : velocity_(motion.velocity) {
    Affine shift;
    shift.translation = Vec3d(grid.field.origin());
    const Affine to_world = grid.index_to_world.after(shift);
    to_velocity_ = velocity_.index_to_world().inverse().after(to_world);
    const Affine to_local = to_world.inverse();
    const VelocityScale meaning = scale_of(motion.settings, velocity_.from_mantaflow());
    turn_ = meaning.index ? to_local.after(velocity_.index_to_world()) : to_local;
    time_ = motion.settings.time * meaning.factor;
  }

  /// Steps of the density's lattice that make about one step of the velocity's: a divisor of the
  /// bricks' width.
  int stride() const {
    double step = 0; // in the velocity's lattice
    for (int a = 0; a < 3; ++a) {
      Vec3d along;
      along[a] = 1;
      step = std::max(step, length(to_velocity_.vector(along)));
    }
    int stride = 1;
    while (stride < cell_width && 2 * stride * step < 1 + 1e-6)
      stride *= 2;
    return stride;
  }

  Vec3d at(const Vec3d& local) const {
    return turn_.vector(velocity_.sample(to_velocity_.point(local))) * time_;
  }
  /// Bounds of the displacements in a box.
  Boxd bounds(const Boxd& local) const {
    const Boxf velocities = velocity_.bounds(to_velocity_.bounds(local));
    Affine turn = turn_;
    turn.translation = {};
    const Boxd box = turn.bounds({Vec3d(velocities.lower), Vec3d(velocities.upper)});
    return {min(box.lower * time_, box.upper * time_), max(box.lower * time_, box.upper * time_)};
  }
  /// The point that comes to `local`. `way`: a guess of the displacement from there, which is
  /// improved.
  Vec3d source_of(const Vec3d& local, Vec3d& way) const {
    for (int step = 0; step < fixed_point_steps; ++step) {
      const Vec3d next = at(local - way), change = next - way;
      way = next;
      if (dot(change, change) < near_enough * near_enough)
        break;
    }
    return local - way;
  }

private:
  const VectorField& velocity_;
  Affine to_velocity_, turn_;
  double time_;
};

} // namespace vdbeam
