#pragma once

#include "lights/entry_sampler.h"
#include "lights/light.h"

namespace vdbeam {

/// A photon of light that comes from all around, from far away. `draw(u, v)` gives the direction
/// towards the light and its radiance over the direction's density, as `direction` and `value`.
template <class Draw>
EmittedPhoton emit_from_all_around(const EntrySampler& boxes, double place, Rng& rng,
                                   const Draw& draw) {
  const float u_face = static_cast<float>(place), u = rng.uniform(), v = rng.uniform();
  const float u_direction = rng.uniform(), v_direction = rng.uniform();
  const auto drawn = draw(u_direction, v_direction);
  const EntrySampler::Entry entry = boxes.sample_line(-drawn.direction, u_face, u, v);
  return {{entry.point, -drawn.direction}, drawn.value * entry.weight};
}

} // namespace vdbeam
