#include "estimators/direct_light.h"

namespace vdbeam {

namespace {

/// A scattering point drawn along the ray.
struct ScatterPoint {
  Vec3f position;
  float t = 0;
  std::size_t knot = 0; ///< the point lies between knots `knot` and `knot + 1`
};

/// Draws a distance with density sigma_c Tr_c / (1 - Tr_c(end)) of channel c.
class DistanceSampler {
public:
  DistanceSampler(const Medium& medium, const DepthProfile& profile)
      : medium_(medium), profile_(profile), end_(profile.channels(medium, profile.knots() - 1)) {}

  /// Probability of scattering at all on this ray, per channel.
  float opacity(int c) const { return -std::expm1(-end_[c]); }

  ScatterPoint sample(const Ray& ray, float u, int c) const {
    const float tau = std::min(-std::log1p(-u * opacity(c)), end_[c]);
    std::size_t low = 0, high = profile_.knots() - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (channel_tau(middle, c) <= tau ? low : high) = middle;
    }
    const float a = channel_tau(low, c), b = channel_tau(low + 1, c);
    const float fraction = b > a ? std::clamp((tau - a) / (b - a), 0.0f, 1.0f) : 0.5f;
    ScatterPoint point;
    point.knot = low;
    point.t = profile_.t(low) + fraction * (profile_.t(low + 1) - profile_.t(low));
    point.position = ray.at(point.t);
    return point;
  }

  /// sigma_s Tr / pdf of volume v at the point, where the channel was chosen with equal chance
  /// (balance heuristic over the channels).
  Rgb weight(const ScatterPoint& point, std::size_t v) const {
    const float length = profile_.t(point.knot + 1) - profile_.t(point.knot);
    const float fraction = length > 0 ? (point.t - profile_.t(point.knot)) / length : 0.5f;
    const auto piece = [&](std::size_t i) {
      return profile_.tau(point.knot + 1, i) - profile_.tau(point.knot, i);
    };
    const Volume& volume = medium_.volumes[v];
    if (!medium_.chromatic) {
      float sum = 0;
      for (std::size_t i = 0; i < profile_.volume_count(); ++i)
        sum += piece(i);
      return sum > 0 ? volume.albedo * (piece(v) / sum * opacity(0)) : Rgb(0);
    }
    const Rgb tau_a = profile_.channels(medium_, point.knot);
    const Rgb tau_b = profile_.channels(medium_, point.knot + 1);
    Rgb result;
    float pdf = 0;
    for (int c = 0; c < 3; ++c) {
      const float tr = std::exp(-(tau_a[c] + fraction * (tau_b[c] - tau_a[c])));
      result[c] = volume.albedo[c] * volume.channel_scale[c] * piece(v) * tr;
      if (opacity(c) > 0)
        pdf += (tau_b[c] - tau_a[c]) * tr / opacity(c) / 3;
    }
    return pdf > 0 ? result / pdf : Rgb(0);
  }

private:
  float channel_tau(std::size_t knot, int c) const {
    if (!medium_.chromatic)
      return profile_.total(knot);
    float sum = 0;
    for (std::size_t v = 0; v < profile_.volume_count(); ++v)
      sum += medium_.volumes[v].channel_scale[c] * profile_.tau(knot, v);
    return sum;
  }

  const Medium& medium_;
  const DepthProfile& profile_;
  Rgb end_;
};

/// Radiance that one light scatters at a point into the ray, per unit of weight.
Rgb scattered_light(const World& world, const Light& light, const PhaseFunction& phase,
                    const Vec3f& point, const Vec3f& direction, Rng& rng) {
  Rgb sum;
  const float u = rng.uniform(), v = rng.uniform();
  const IncidentSample sample = light.sample_incident(point, u, v);
  if (max_component(sample.value) > 0) {
    const float p = phase.evaluate(dot(direction, sample.wi));
    const float mis = sample.pdf > 0 ? sample.pdf / (sample.pdf + p) : 1;
    if (p * mis > 0)
      sum += sample.value * (p * mis) *
             ratio_transmittance(world.medium, {point, sample.wi}, sample.distance, rng);
  }
  if (light.is_delta())
    return sum;
  const float u_lobe = rng.uniform(), u2 = rng.uniform(), v2 = rng.uniform();
  const Vec3f wi = phase.sample(direction, u_lobe, u2, v2);
  const Rgb radiance = light.escaped_radiance(wi);
  if (max_component(radiance) > 0) {
    const float p = phase.evaluate(dot(direction, wi));
    const float mis = p / (p + light.incident_pdf(point, wi));
    sum += radiance * mis * ratio_transmittance(world.medium, {point, wi}, infinity, rng);
  }
  return sum;
}

} // namespace

Rgb direct_light(const World& world, const Ray& ray, const DepthProfile& profile,
                 const std::vector<bool>& sampled, int samples, Rng& rng) {
  Rgb sum;
  if (profile.empty() || std::find(sampled.begin(), sampled.end(), true) == sampled.end())
    return sum;
  const Medium& medium = world.medium;
  const DistanceSampler distances(medium, profile);
  for (int i = 0; i < samples; ++i) {
    const float u = (static_cast<float>(i) + rng.uniform()) / static_cast<float>(samples);
    const int c = medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
    if (!(distances.opacity(c) > 0))
      continue;
    const ScatterPoint point = distances.sample(ray, u, c);
    for (std::size_t v = 0; v < medium.volumes.size(); ++v) {
      const Rgb weight = distances.weight(point, v);
      if (!(max_component(weight) > 0))
        continue;
      for (std::size_t l = 0; l < world.lights.size(); ++l)
        if (sampled[l])
          sum += weight * scattered_light(world, world.lights[l],
                                          medium.phases[medium.volumes[v].group], point.position,
                                          ray.direction, rng);
    }
  }
  return sum / static_cast<float>(samples);
}

} // namespace vdbeam
