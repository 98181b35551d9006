#include "lights/lamps/local_light.h"
#include "lights/lamps/shaped_lamp.h"
#include "lights/light_table.h"
#include "math/color.h"

namespace vdbeam {
namespace {

/// A point that shines alike in all directions.
class PointLight final : public LocalLight {
public:
  PointLight(const LightSettings& settings, const LightContext& context)
      : LocalLight(settings, context,
                   cone_towards(render_position(settings, context), context.region)) {}

  Rgb power() const override { return Rgb(intensity() * emission_cone().solid_angle()); }

private:
  Vec3d share(const Vec3d&) const override { return Vec3d(1); }
};

std::unique_ptr<Light> make_point_light(const LightSettings& settings,
                                        const LightContext& context) {
  if (is_shaped(settings))
    return make_shaped_lamp(settings, context);
  LightSettings point = settings;
  if (settings.power)
    point.intensity = Rgb(Vec3d(*settings.power) / (4 * std::numbers::pi));
  return std::make_unique<PointLight>(point, context);
}

std::optional<KeyComplaint> point_complaint(const LightSettings& settings) {
  return settings.ies.empty() ? std::nullopt : direction_complaint(settings);
}

constexpr std::string_view point_keys[] = {"position", "intensity", "power",
                                           "ies",      "direction", "rotation"};

} // namespace

const LightKind point_light{.name = "point",
                            .help = "a point that emits in all directions",
                            .keys = point_keys,
                            .colored =
                                [](const LightSettings& light) {
                                  return !is_grey(light.intensity) ||
                                         !is_grey(light.power.value_or(Rgb(1)));
                                },
                            .complaint = point_complaint,
                            .make = make_point_light};

} // namespace vdbeam
