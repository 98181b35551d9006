#include "lights/light_table.h"
#include "vdbeam/error.h"
#include "volume/blackbody.h"

#include <fmt/core.h>

namespace vdbeam {

const LightKind& light_kind(const LightType& type) {
  for (const LightKind* kind : light_table())
    if (kind->name == type.name)
      return *kind;
  throw InputError(fmt::format("light.type: there is no light \"{}\"", type.name));
}

LightSettings tinted(LightSettings settings) {
  if (!settings.kelvin && settings.exposure == 0)
    return settings;
  const Rgb tint = light_tint(settings.kelvin, settings.exposure, settings.color_space);
  settings.irradiance *= tint;
  settings.intensity *= tint;
  settings.radiance *= tint;
  if (settings.power)
    *settings.power *= tint;
  settings.kelvin.reset();
  settings.exposure = 0;
  return settings;
}

std::unique_ptr<Light> make_light(const LightSettings& settings, const LightContext& context) {
  return light_kind(settings.type).make(tinted(settings), context);
}

std::optional<KeyComplaint> direction_complaint(const LightSettings& settings) {
  if (length(settings.direction) == 0)
    return KeyComplaint{"direction", "must not be [0, 0, 0]"};
  return std::nullopt;
}

Rgb estimate_power(const Light& light, int photons) {
  Vec3d sum;
  for (int i = 0; i < photons; ++i) {
    Rng rng({}, RngStage::light, static_cast<std::uint64_t>(i));
    sum += Vec3d(light.emit(rng).flux);
  }
  return Rgb(sum / static_cast<double>(photons));
}

Vec3d unit_direction(const Vec3d& v, const char* key) {
  const double scale = max_component(Vec3d{std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(scale > 0 && scale < std::numeric_limits<double>::infinity()))
    throw InputError(fmt::format("{} must have a direction, got [{}, {}, {}]", key, v.x, v.y, v.z));
  return normalize(v / scale);
}

} // namespace vdbeam
