#include "transport/optical_depth.h"

#include "transport/delta_tracking.h"

namespace vdbeam {

Rgb exact_transmittance(const Medium& medium, const Segment& segment, Rgb* taken_out) {
  Rgb tau{0, 0, 0};
  for (std::size_t v = 0; v < medium.volumes.size(); ++v) {
    const Volume& volume = medium.volumes[v];
    // The weakest channel decides when nothing is left in any.
    const float weakest =
        std::min(volume.channel_scale.x, std::min(volume.channel_scale.y, volume.channel_scale.z));
    float sum = 0;
    for_each_piece(volume, segment, [&](float, float, float piece) {
      sum += piece;
      return sum * weakest < opaque_optical_depth;
    });
    tau += volume.channel_scale * sum;
    if (taken_out && medium.peak)
      *taken_out += medium.peak->excess[v] * sum;
  }
  return {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
}

bool RatioTracking::attenuate(Rng& rng) {
  constexpr float roulette_below = 0.1f;
  const Collision hit = tracker_.collision();
  weight_ *= Rgb(1) - hit.volume->channel_scale * (hit.sigma_t / hit.majorant);
  const float largest = max_component(weight_);
  if (largest >= roulette_below)
    return true;
  const bool survives = rng.uniform() * roulette_below < largest;
  weight_ = survives ? weight_ * (roulette_below / largest) : Rgb(0);
  return survives;
}

} // namespace vdbeam
