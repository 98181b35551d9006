#include "medium/optical_depth.h"

#include "math/opacity.h"
namespace vdbeam {

LayeredSegment::LayeredSegment(const Volume& volume, const Segment& segment)
    : layers_(*volume.field.layers()), extinction_(volume.extinction),
      top_(layers_.upper(layers_.count() - 1)) {
  const Vec3f o = volume.local_point(segment.ray.origin);
  const Vec3f d = volume.local_vector(segment.ray.direction);
  origin_ = o.y;
  slope_ = d.y;
  const Vec3f size = Vec3f(volume.field.cell_counts()) * float{cell_width};
  const GridTraversal box(o / size, d / size, Vec3<int>(1), segment.t_begin, segment.t_end);
  if (box.done())
    return;
  t_begin_ = box.t();
  t_end_ = box.t_exit();
}

float LayeredSegment::optical_depth() const {
  if (empty())
    return 0;
  const double mean = layers_.mean_density(height(t_begin_), height(t_end_));
  return extinction_ * static_cast<float>(std::max(mean, 0.0)) * (t_end_ - t_begin_);
}

namespace {

/// Per channel; ends once `weakest`, the sum over the volumes of the depth in their weakest
/// channel, reaches `limit`.
Rgb optical_depth(const Medium& medium, const Segment& segment, float limit, float& weakest,
                  Rgb* taken_out) {
  Rgb tau{0, 0, 0};
  weakest = 0;
  medium.for_each_met(segment, [&](std::size_t v) {
    if (weakest >= limit)
      return;
    const Volume& volume = medium.volumes[v];
    const float scale =
        std::min(volume.channel_scale.x, std::min(volume.channel_scale.y, volume.channel_scale.z));
    float sum = 0;
    if (volume.field.layers())
      sum = LayeredSegment(volume, segment).optical_depth();
    else
      for_each_piece(volume, segment, [&](float, float, float piece) {
        sum += piece;
        return weakest + sum * scale < limit;
      });
    weakest += sum * scale;
    tau += volume.channel_scale * sum;
    if (taken_out && medium.peak)
      *taken_out += medium.peak->excess[v] * sum;
  });
  return tau;
}

} // namespace

Rgb exact_transmittance(const Medium& medium, const Segment& segment, Rgb* taken_out) {
  float weakest = 0;
  return transmittance_of(optical_depth(medium, segment, opaque_optical_depth, weakest, taken_out));
}

Rgb estimate_transmittance(const Medium& medium, const Segment& segment, float u, Rgb* taken_out,
                           float certain_depth) {
  const float limit = std::min(certain_depth - std::log1p(-u), opaque_optical_depth);
  float weakest = 0;
  const Rgb tau = optical_depth(medium, segment, limit, weakest, taken_out);
  if (weakest >= limit)
    return Rgb(0);
  // exp(-tau) over the chance exp(certain_depth - weakest) to get here.
  const float given = std::max(0.0f, weakest - certain_depth);
  return transmittance_of(tau - Rgb(given));
}

bool RatioTracking::attenuate(Rng& rng) {
  const Collision hit = tracker_.collision();
  weight_ *= Rgb(1) - hit.volume->channel_scale * (hit.sigma_t / hit.majorant);
  const float largest = max_component(weight_);
  if (largest < tuning::roulette_below) {
    const bool survives = rng.uniform() * tuning::roulette_below < largest;
    weight_ = survives ? weight_ * (tuning::roulette_below / largest) : Rgb(0);
    if (!survives)
      return false;
  }
  if (++collisions_ < most_tentative_collisions)
    return true;
  weight_ *= exact_transmittance(*medium_, {segment_.ray, hit.t, segment_.t_end});
  return false;
}

} // namespace vdbeam
