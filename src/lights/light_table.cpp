#include "lights/light_table.h"

#include "vdbeam/error.h"

#include <fmt/core.h>

#include <array>

namespace vdbeam {

std::span<const LightKind> light_table() {
  static constexpr std::array<LightKind, 5> table{{
      {LightType::distant, "distant", make_distant_light},
      {LightType::point, "point", make_point_light},
      {LightType::spot, "spot", make_spot_light},
      {LightType::environment, "environment", make_environment_light},
      {LightType::sky, "sky", make_sky_light},
  }};
  return table;
}

Rgb estimate_power(const Light& light) {
  constexpr int count = 4096;
  Vec3d sum;
  for (int i = 0; i < count; ++i) {
    Rng rng({}, RngStage::light, static_cast<std::uint64_t>(i));
    sum += Vec3d(light.emit(rng).flux);
  }
  return Rgb(sum / static_cast<double>(count));
}

Vec3d unit_direction(const Vec3d& v, const char* key) {
  const double scale = max_component(Vec3d{std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(scale > 0 && scale < std::numeric_limits<double>::infinity()))
    throw InputError(fmt::format("{} must have a direction, got [{}, {}, {}]", key, v.x, v.y, v.z));
  return normalize(v / scale);
}

} // namespace vdbeam
