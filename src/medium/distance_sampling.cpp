#include "medium/distance_sampling.h"

namespace vdbeam {

float DistanceSampler::channel_tau(std::size_t knot, int c) const {
  if (!medium_.chromatic)
    return profile_.total(knot);
  float sum = 0;
  for (std::size_t v = 0; v < profile_.volume_count(); ++v)
    sum += medium_.volumes[profile_.volume(v)].channel_scale[c] * profile_.tau(knot, v);
  return sum;
}

ScatterPoint DistanceSampler::sample(float u, int c) {
  const float end = channel_tau(profile_.knots() - 1, c);
  const float tau = std::min(-std::log1p(-u * opacity(c)), end);
  // Among pieces that meet at this optical depth, the last one, so that empty ones are skipped; at
  // the very end the first one, since only empty ones can follow.
  const auto lies_behind = [&](std::size_t knot) {
    const float at_knot = channel_tau(knot, c);
    return tau < end ? at_knot <= tau : at_knot < tau;
  };
  std::size_t low = 0, high = profile_.knots() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (lies_behind(middle) ? low : high) = middle;
  }
  const float a = channel_tau(low, c), b = channel_tau(low + 1, c);
  const float fraction = b > a ? std::clamp((tau - a) / (b - a), 0.0f, 1.0f) : 0.5f;
  const float t = profile_.t(low) + fraction * (profile_.t(low + 1) - profile_.t(low));
  return weigh(low, t);
}

ScatterPoint DistanceSampler::at(float t) {
  std::size_t low = 0, high = profile_.knots() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (profile_.t(middle) <= t ? low : high) = middle;
  }
  return weigh(low, t);
}

/// weight_v = sigma_s,v(t) Tr(t) / pdf(t), Tr with the air before. Between two knots every volume's
/// density is a cubic in t, so the optical depth from the knot to t is known exactly. The density
/// of the draw is sigma' exp(-tau') / opacity with the profile's own piecewise linear tau',
/// averaged over the channels (balance heuristic).
ScatterPoint DistanceSampler::weigh(std::size_t knot, float t) {
  const float t_a = profile_.t(knot), length = profile_.t(knot + 1) - t_a;
  Rgb tau, linear_tau, linear_sigma;
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    const Volume& volume = medium_.volumes[profile_.volume(v)];
    const float begin = profile_.tau(knot, v), piece = profile_.tau(knot + 1, v) - begin;
    const Vec3f point = ray_.at(t);
    const float sigma = volume.extinction * volume.density_inside(point);
    const float exact = piece > 0 ? cube_optical_depth(volume, ray_, t_a, t) : 0;
    tau += volume.channel_scale * (begin + exact);
    linear_tau += volume.channel_scale * (begin + (length > 0 ? (t - t_a) / length : 0) * piece);
    linear_sigma += volume.channel_scale * (length > 0 ? piece / length : sigma);
    weights_[v] = volume.albedo_at(point) * volume.channel_scale * (piece > 0 ? sigma : 0);
  }
  const int channels = medium_.chromatic ? 3 : 1;
  float pdf = 0;
  Rgb transmittance;
  for (int c = 0; c < channels; ++c) {
    transmittance[c] = std::exp(-tau[c]);
    if (opacity(c) > 0)
      pdf += linear_sigma[c] * std::exp(-linear_tau[c]) / opacity(c) / static_cast<float>(channels);
  }
  if (!medium_.chromatic)
    transmittance = Rgb(transmittance.x);
  if (profile_.air())
    transmittance *= profile_.air().left(t);
  for (Rgb& weight : weights_)
    weight *= pdf > 0 ? transmittance / pdf : Rgb(0);
  return {t, pdf, ray_.at(t), &weights_, &profile_.met()};
}

std::optional<VolumeChoice> choose_volume(const ScatterPoint& point, float u) {
  const std::vector<Rgb>& weights = *point.weights;
  float total = 0;
  for (const Rgb& weight : weights)
    total += mean_component(weight);
  if (!(total > 0))
    return std::nullopt;
  std::size_t volume = 0;
  float left = u * total - mean_component(weights[0]);
  while (left >= 0 && volume + 1 < weights.size())
    left -= mean_component(weights[++volume]);
  const float own = mean_component(weights[volume]);
  if (!(own > 0))
    return std::nullopt;
  return VolumeChoice{(*point.volumes)[volume], weights[volume] * (total / own)};
}

} // namespace vdbeam
