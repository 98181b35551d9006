#include "lights/lamps/shaped_lamp.h"
#include "lights/lamps/spot_cone.h"
#include "lights/light_table.h"
#include "math/color.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

/// A point that shines within a cone, with an edge that falls smoothly.
class SpotLight final : public LocalLight {
public:
  SpotLight(const LightSettings& settings, const LightContext& context)
      : LocalLight(settings, context,
                   narrower(SpotCone(settings).outer(),
                            cone_towards(render_position(settings, context), context.region))),
        cone_(settings) {
    power_ = estimate_power(*this);
  }

  Rgb power() const override { return power_; }
  Segment lit_part(const Segment& segment) const override {
    return part_within(cone_.outer(), *position(), segment);
  }

private:
  Vec3d share(const Vec3d& direction) const override { return Vec3d(cone_.share(direction)); }

  SpotCone cone_;
  Rgb power_;
};

std::unique_ptr<Light> make_spot_light(const LightSettings& settings, const LightContext& context) {
  if (is_shaped(settings))
    return make_shaped_lamp(settings, context);
  LightSettings spot = settings;
  if (settings.power)
    spot.intensity = Rgb(Vec3d(*settings.power) / SpotCone(settings).integral());
  return std::make_unique<SpotLight>(spot, context);
}

std::optional<KeyComplaint> spot_complaint(const LightSettings& settings) {
  if (settings.cone_falloff > settings.cone_angle)
    return KeyComplaint{"cone_falloff", fmt::format("must be at most cone_angle ({}), got {}",
                                                    settings.cone_angle, settings.cone_falloff)};
  constexpr double widest = 89;
  if (!settings.image.empty() && settings.cone_angle > widest)
    return KeyComplaint{"cone_angle", fmt::format("must be at most {} for an image, got {}", widest,
                                                  settings.cone_angle)};
  return direction_complaint(settings);
}

constexpr std::string_view spot_keys[] = {"direction", "position",   "intensity",
                                          "power",     "cone_angle", "cone_falloff",
                                          "ies",       "image",      "rotation"};

} // namespace

const LightKind spot_light{.name = "spot",
                           .help = "a point that emits into a cone",
                           .keys = spot_keys,
                           .colored =
                               [](const LightSettings& light) {
                                 return !is_grey(light.intensity) ||
                                        !is_grey(light.power.value_or(Rgb(1))) ||
                                        !light.image.empty();
                               },
                           .complaint = spot_complaint,
                           .make = make_spot_light};

} // namespace vdbeam
