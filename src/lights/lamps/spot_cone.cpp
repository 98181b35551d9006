#include "lights/lamps/spot_cone.h"

#include "lights/light_table.h"

namespace vdbeam {

SpotCone::SpotCone(const LightSettings& settings)
    : outer_{unit_direction(settings.direction, "light.direction"),
             one_minus_cos_degrees(std::clamp(settings.cone_angle, 0.0, 180.0))},
      inner_(one_minus_cos_degrees(std::max(0.0, settings.cone_angle - settings.cone_falloff))) {}

double SpotCone::share(const Vec3d& direction) const {
  const Vec3d chord = direction - outer_.axis;
  const double x = dot(chord, chord) / 2; // 1 - cos, exact for narrow cones
  if (x >= outer_.one_minus_cos)
    return 0;
  if (x <= inner_)
    return 1;
  const double t = (outer_.one_minus_cos - x) / (outer_.one_minus_cos - inner_);
  return t * t * (3 - 2 * t);
}

double SpotCone::integral() const {
  return std::numbers::pi * (inner_ + outer_.one_minus_cos); // half of the edge's solid angle
}

} // namespace vdbeam
