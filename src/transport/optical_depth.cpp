#include "transport/optical_depth.h"

#include "transport/delta_tracking.h"

namespace vdbeam {

Rgb exact_transmittance(const Medium& medium, const Ray& ray, float t_end) {
  Rgb tau{0, 0, 0};
  for (const Volume& volume : medium.volumes) {
    // The weakest channel decides when nothing is left in any.
    const float weakest =
        std::min(volume.channel_scale.x, std::min(volume.channel_scale.y, volume.channel_scale.z));
    float sum = 0;
    walk_segments(volume, ray, 0, t_end, [&](float, float, float piece) {
      sum += piece;
      return sum * weakest < opaque_optical_depth;
    });
    tau += volume.channel_scale * sum;
  }
  return {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
}

Rgb ratio_transmittance(const Medium& medium, const Ray& ray, float t_end, Rng& rng) {
  if (medium.empty())
    return Rgb(1);
  constexpr float roulette_below = 0.1f;
  MediumTracker tracker(medium, ray, 0, t_end);
  Rgb weight(1);
  for (Collision hit = tracker.next(rng); hit.t < t_end; hit = tracker.next(rng)) {
    const float ratio = hit.sigma_t / hit.majorant;
    weight *= Rgb(1) - hit.volume->channel_scale * ratio;
    const float largest = max_component(weight);
    if (largest < roulette_below) {
      if (rng.uniform() * roulette_below >= largest)
        return Rgb(0);
      weight *= roulette_below / largest;
    }
  }
  return weight;
}

} // namespace vdbeam
