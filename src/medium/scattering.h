#pragma once

#include "medium/delta_tracking.h"

namespace vdbeam {

/// One decision of spectral tracking (Kutz et al. 2017, history-aware) at a tentative collision:
/// real or null, in proportion to what each does to the weight, so that no channel's weight can
/// grow without bound. With grey extinction this is delta tracking's own decision.
inline bool sample_real_collision(const Collision& hit, bool chromatic, Rgb& weight, Rng& rng) {
  const float ratio = hit.sigma_t / hit.majorant;
  if (!chromatic)
    return rng.uniform() < ratio;
  const Rgb real = hit.volume->channel_scale * ratio;
  const Rgb null = Rgb(1) - real;
  const float real_share = dot(weight, real), null_share = dot(weight, null);
  const float probability = real_share / (real_share + null_share);
  if (rng.uniform() < probability) {
    weight *= real / probability;
    return true;
  }
  weight *= null / (1 - probability);
  return false;
}

/// Absorption by Russian roulette: the weight takes the albedo's colour, its strongest channel
/// keeps its value. False where the path ends.
inline bool absorption_roulette(const Rgb& albedo, Rgb& weight, Rng& rng) {
  const float before = max_component(weight);
  weight *= albedo;
  const float after = max_component(weight);
  if (!(after > 0))
    return false;
  if (after < before) {
    if (rng.uniform() * before >= after)
      return false;
    weight *= before / after;
  }
  return true;
}

/// Russian roulette once the weight falls under `threshold`, which survivors carry. False where the
/// path ends.
inline bool survive_roulette(float threshold, Rgb& weight, Rng& rng) {
  const float largest = max_component(weight);
  if (largest >= threshold)
    return true;
  if (!(largest > 0) || rng.uniform() * threshold >= largest)
    return false;
  weight *= threshold / largest;
  return true;
}

/// Russian roulette on the length of a path that absorption does not end. In a deep, conservative
/// medium the chance to be still under way after n collisions falls as 1 / sqrt(n) only, so the
/// mean work grows with the optical depth. From `first` collisions on a path goes on with the
/// chance 1 / sqrt(2) whenever its length has doubled: the work per doubling and the second moment
/// of what it brings back stay constant both. A path that begins deep inside, or whose collisions
/// lie closer together than single precision resolves, does not come back like that; its work
/// would have no bound. So from `late` collisions on the chance is 1 / 4, which bounds the mean
/// number of collisions by 50,000 whatever the medium.
class LengthRoulette {
public:
  /// Counts one collision. False where the path ends.
  bool survive(Rgb& weight, Rng& rng) {
    if (++collisions_ < next_)
      return true;
    next_ *= 2;
    const float chance = collisions_ < late ? early_chance : late_chance;
    if (rng.uniform() >= chance)
      return false;
    weight *= 1 / chance;
    return true;
  }

  /// True from where it may end a path.
  bool begun() const { return next_ > first; }

private:
  static constexpr std::uint64_t first = 4096;
  static constexpr std::uint64_t late = std::uint64_t{1} << 17;
  static constexpr float early_chance = 0.70710678f, late_chance = 0.25f;
  std::uint64_t collisions_ = 0, next_ = first;
};

} // namespace vdbeam
