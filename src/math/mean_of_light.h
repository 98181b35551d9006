#pragma once

#include "math/grouped_light.h"

namespace vdbeam {

/// Mean of independent estimates of light.
class MeanOfLight {
public:
  void add(const GroupedLight& light) {
    sum_ += light;
    squares_ += light.sum() * light.sum();
    ++count_;
  }
  GroupedLight mean() const { return sum_ * (1 / count_); }
  /// The mean's, estimated from at least two.
  Rgb variance() const {
    const Rgb mean = sum_.sum() * (1 / count_);
    return (squares_ * (1 / count_) - mean * mean) * (1 / (count_ - 1));
  }

private:
  GroupedLight sum_;
  Rgb squares_;
  float count_ = 0;
};

} // namespace vdbeam
