#include "lights/light_table.h"
#include "lights/local_light.h"
#include "math/color.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

/// The narrower of two cones that both hold every useful direction.
Cone narrower(const Cone& a, const Cone& b) {
  return a.one_minus_cos <= b.one_minus_cos ? a : b;
}

/// A point that shines within a cone, with an edge that falls smoothly (cubic Hermite in the
/// cosine).
class SpotLight final : public LocalLight {
public:
  SpotLight(const LightSettings& settings, const LightContext& context)
      : LocalLight(settings, context,
                   narrower(outer_cone(settings),
                            cone_towards(render_position(settings, context), context.region))),
        outer_(outer_cone(settings)),
        inner_(one_minus_cos_degrees(std::max(0.0, settings.cone_angle - settings.cone_falloff))) {
    power_ = estimate_power(*this);
  }

  Rgb power() const override { return power_; }
  Segment lit_part(const Segment& segment) const override {
    return part_within(outer_, *position(), segment);
  }

private:
  static Cone outer_cone(const LightSettings& settings) {
    return {unit_direction(settings.direction, "light.direction"),
            one_minus_cos_degrees(std::clamp(settings.cone_angle, 0.0, 180.0))};
  }

  double share(const Vec3d& direction) const override {
    const Vec3d chord = direction - outer_.axis;
    const double x = dot(chord, chord) / 2; // 1 - cos, exact for narrow cones
    if (x >= outer_.one_minus_cos)
      return 0;
    if (x <= inner_)
      return 1;
    const double t = (outer_.one_minus_cos - x) / (outer_.one_minus_cos - inner_);
    return t * t * (3 - 2 * t);
  }

  Cone outer_;
  double inner_; ///< 1 - cos of the angle up to which the light is even
  Rgb power_;
};

std::unique_ptr<Light> make_spot_light(const LightSettings& settings, const LightContext& context) {
  return std::make_unique<SpotLight>(settings, context);
}

std::optional<KeyComplaint> spot_complaint(const LightSettings& settings) {
  if (settings.cone_falloff > settings.cone_angle)
    return KeyComplaint{"cone_falloff", fmt::format("must be at most cone_angle ({}), got {}",
                                                    settings.cone_angle, settings.cone_falloff)};
  return direction_complaint(settings);
}

constexpr std::string_view spot_keys[] = {"direction", "position", "intensity", "cone_angle",
                                          "cone_falloff"};

} // namespace

const LightKind spot_light{
    .name = "spot",
    .help = "a point that emits into a cone",
    .keys = spot_keys,
    .colored = [](const LightSettings& light) { return !is_grey(light.intensity); },
    .complaint = spot_complaint,
    .make = make_spot_light};

} // namespace vdbeam
