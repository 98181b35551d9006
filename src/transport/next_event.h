#pragma once

#include "lights/light.h"
#include "math/rng.h"

#include <optional>

namespace vdbeam {

/// A shadow ray from a vertex of a path to a light.
struct ShadowRay {
  Rgb light;       ///< radiance from there over the density with which the ray was drawn
  float weight;    ///< against drawing the direction as the path goes on (balance heuristic)
  Vec3f direction; ///< unit, from the vertex
  float distance;  ///< to the light
};

/// Next-event estimation: draws a shadow ray from `point` to a light, none where no light comes
/// from there. pdf(wi): the density [1/sr] with which the path itself draws the direction wi to go
/// on, 0 where the light is found in no other way. The two are combined by multiple importance
/// sampling (Veach and Guibas 1995). What the vertex scatters, and the transmittance on the way, is
/// left to the caller.
template <class Pdf>
std::optional<ShadowRay> sample_shadow_ray(const Light& light, const Vec3f& point, Rng& rng,
                                           const Pdf& pdf) {
  const float u = rng.uniform(), v = rng.uniform();
  const IncidentSample sample = light.sample_incident(point, u, v);
  if (!(max_component(sample.value) > 0))
    return std::nullopt;
  const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + pdf(sample.wi)) : 1;
  return ShadowRay{sample.value, weight, sample.wi, sample.distance};
}

} // namespace vdbeam
