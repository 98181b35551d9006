#pragma once

#include "math/ray.h"

namespace vdbeam {

/// Traverses the cells of a box of cubic cells along a ray (3D-DDA, Amanatides and Woo 1987). The
/// ray is origin + t * direction in cell coordinates (a cell is a unit cube); `direction` need not
/// have unit length, so t keeps the meaning it has outside.
class GridTraversal {
public:
  /// The part of [t_begin, t_end] inside the box [0, counts]; check done() before use.
  GridTraversal(const Vec3f& origin, const Vec3f& direction, const Vec3<int>& counts, float t_begin,
                float t_end)
      : origin_(origin), direction_(direction), counts_(counts), t_(t_begin), t_end_(t_end) {
    for (int a = 0; a < 3; ++a)
      clip(a);
    if (!(t_ < t_end_)) {
      done_ = true;
      return;
    }
    for (int a = 0; a < 3; ++a)
      enter(a);
    find_exit();
  }

  bool done() const { return done_; }
  float t() const { return t_; }           ///< where the ray entered the present cell
  float t_exit() const { return t_exit_; } ///< where it leaves it
  const Vec3<int>& cell() const { return cell_; }

  /// Advances to the next cell.
  void advance() {
    t_ = t_exit_;
    if (t_next_.x <= t_next_.y && t_next_.x <= t_next_.z)
      step(cell_.x, t_next_.x, origin_.x, inverse_.x, step_.x, counts_.x);
    else if (t_next_.y <= t_next_.z)
      step(cell_.y, t_next_.y, origin_.y, inverse_.y, step_.y, counts_.y);
    else
      step(cell_.z, t_next_.z, origin_.z, inverse_.z, step_.z, counts_.z);
    if (t_ >= t_end_)
      done_ = true;
    find_exit();
  }

private:
  void clip(int a) {
    const float o = origin_[a], d = direction_[a], n = static_cast<float>(counts_[a]);
    if (d == 0) {
      if (!(o >= 0 && o < n))
        t_end_ = t_ - 1;
      return;
    }
    inverse_[a] = 1 / d;
    t_ = std::max(t_, (d > 0 ? -o : n - o) * inverse_[a]);
    t_end_ = std::min(t_end_, (d > 0 ? n - o : -o) * inverse_[a]);
  }

  void enter(int a) {
    const float position = origin_[a] + t_ * direction_[a];
    cell_[a] = std::clamp(static_cast<int>(position), 0, counts_[a] - 1);
    step_[a] = direction_[a] > 0 ? 1 : -1;
    t_next_[a] = direction_[a] == 0
                     ? infinity
                     : (static_cast<float>(cell_[a] + (step_[a] > 0)) - origin_[a]) * inverse_[a];
  }

  /// The boundary is computed from the cell number, so that rounding errors do not accumulate.
  void step(int& cell, float& t_next, float origin, float inverse, int direction, int count) {
    cell += direction;
    if (cell < 0 || cell >= count)
      done_ = true;
    t_next = (static_cast<float>(cell + (direction > 0)) - origin) * inverse;
  }

  void find_exit() {
    t_exit_ = std::min(t_end_, std::max(t_, std::min(t_next_.x, std::min(t_next_.y, t_next_.z))));
  }

  Vec3f origin_, direction_, inverse_, t_next_;
  Vec3<int> counts_, cell_, step_;
  float t_, t_end_, t_exit_ = 0;
  bool done_ = false;
};

} // namespace vdbeam
