#include "lights/light_table.h"
#include "lights/local_aim.h"
#include "lights/local_light.h"
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
  double share(const Vec3d&) const override { return 1; }
};

std::unique_ptr<Light> make_point_light(const LightSettings& settings,
                                        const LightContext& context) {
  return std::make_unique<PointLight>(settings, context);
}

constexpr std::string_view point_keys[] = {"position", "intensity"};

} // namespace

const LightKind point_light{
    .name = "point",
    .help = "a point that emits in all directions",
    .keys = point_keys,
    .colored = [](const LightSettings& light) { return !is_grey(light.intensity); },
    .make = make_point_light};

} // namespace vdbeam
