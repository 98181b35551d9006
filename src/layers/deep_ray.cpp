#include "layers/deep_ray.h"

#include "medium/emission.h"

#include <algorithm>

namespace vdbeam {

void DeepRay::add_by_opacity(const Rgb& light) const {
  const auto opacity = [&](std::size_t i) {
    return (*deep_)[(first_ + i) * DeepLayout::values_per_piece + 3];
  };
  float all = 0;
  for (std::size_t i = 0; i < count_; ++i)
    all += opacity(i);
  for (std::size_t i = 0; i < count_ && all > 0; ++i)
    add_light(i, light * (opacity(i) / all));
}

void DeepRay::add_opacity(const Medium& medium, const DepthProfile& profile) const {
  if (!deep_ || profile.empty())
    return;
  ProfileCursor cursor(profile);
  Rgb before; // optical depth where the piece begins
  for (std::size_t i = 0; i < count_; ++i) {
    cursor.move_to(std::min(end(i), profile.back()));
    const Rgb after = cursor.channels(medium);
    float opacity = 0;
    for (int c = 0; c < 3; ++c) // no difference of transmittances, which would lose digits
      opacity += std::exp(-before[c]) * opacity_of(after[c] - before[c]);
    (*deep_)[(first_ + i) * DeepLayout::values_per_piece + 3] += opacity / 3;
    before = after;
  }
}

void DeepRay::add_emission(const Medium& medium, const Segment& segment,
                           const DepthProfile& profile, float cutoff) const {
  for (std::size_t i = 0; deep_ && i < count_; ++i) {
    Segment piece = segment;
    piece.t_begin = std::max(segment.t_begin, begin(i));
    piece.t_end = std::min(segment.t_end, end(i));
    if (!piece.empty())
      add_light(i, emission_along(medium, piece, profile, cutoff));
  }
}

} // namespace vdbeam
