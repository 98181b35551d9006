#pragma once

#include "vdbeam/vec.h"

#include <cstddef>
#include <vector>

namespace vdbeam {

/// Light, and the part of it that comes from each group of lights. Everything that finds light adds
/// it with the group of the light that sent it; everything that weighs light weighs all parts.
/// Where lights have no groups there are no parts, and this is hardly more than its sum.
class GroupedLight {
public:
  GroupedLight() = default;
  /// Light of a group; -1: of none.
  GroupedLight(const Rgb& light, int group) { add(light, group); }
  /// Light whose parts are every `step`-th of `parts`, from `first` on.
  GroupedLight(const Rgb& light, const std::vector<Rgb>& parts, std::size_t first = 0,
               std::size_t step = 1)
      : sum_(light) {
    for (std::size_t i = first; i < parts.size(); i += step)
      parts_.push_back(parts[i]);
  }

  const Rgb& sum() const { return sum_; }
  /// By group; a group beyond the end has no part.
  const std::vector<Rgb>& parts() const { return parts_; }

  void add(const Rgb& light, int group) {
    sum_ += light;
    if (group < 0)
      return;
    const auto at = static_cast<std::size_t>(group);
    if (parts_.size() <= at)
      parts_.resize(at + 1);
    parts_[at] += light;
  }

  GroupedLight& operator+=(const GroupedLight& other) {
    sum_ += other.sum_;
    return combine(other, [](Rgb& to, const Rgb& part) { to += part; });
  }
  GroupedLight& operator-=(const GroupedLight& other) {
    sum_ -= other.sum_;
    return combine(other, [](Rgb& to, const Rgb& part) { to -= part; });
  }
  GroupedLight& operator*=(const Rgb& factor) { return scale(factor); }
  GroupedLight& operator*=(float factor) { return scale(factor); }
  GroupedLight& operator/=(const Rgb& divisor) {
    sum_ = sum_ / divisor;
    for (Rgb& part : parts_)
      part = part / divisor;
    return *this;
  }
  GroupedLight& operator/=(float divisor) {
    sum_ = sum_ / divisor;
    for (Rgb& part : parts_)
      part = part / divisor;
    return *this;
  }

  friend GroupedLight operator+(GroupedLight a, const GroupedLight& b) { return a += b; }
  friend GroupedLight operator-(GroupedLight a, const GroupedLight& b) { return a -= b; }
  template <class Factor>
  friend GroupedLight operator*(GroupedLight light, const Factor& factor) {
    return light *= factor;
  }
  template <class Divisor>
  friend GroupedLight operator/(GroupedLight light, const Divisor& divisor) {
    return light /= divisor;
  }

private:
  template <class Combine>
  GroupedLight& combine(const GroupedLight& other, const Combine& with) {
    if (parts_.size() < other.parts_.size())
      parts_.resize(other.parts_.size());
    for (std::size_t i = 0; i < other.parts_.size(); ++i)
      with(parts_[i], other.parts_[i]);
    return *this;
  }
  template <class Factor>
  GroupedLight& scale(const Factor& factor) {
    sum_ *= factor;
    for (Rgb& part : parts_)
      part *= factor;
    return *this;
  }

  Rgb sum_;
  std::vector<Rgb> parts_;
};

} // namespace vdbeam
