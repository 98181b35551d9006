#include "lights/light_table.h"

#include <array>

namespace vdbeam {

// This list stands alone in its file, so that a program may link another in its place.
std::span<const LightKind* const> light_table() {
  static constexpr std::array table{&distant_light,     &point_light, &spot_light,
                                    &environment_light, &sky_light,   &atmosphere_light,
                                    &sun_light};
  return table;
}

} // namespace vdbeam
