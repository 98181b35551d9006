#pragma once

#include "lights/light.h"
#include "lights/light_context.h"

#include <memory>
#include <span>

namespace vdbeam {

/// One kind of light: a line here and a file with its factory are all that a new light needs.
struct LightKind {
  LightType type;
  const char* name; ///< as scene files call it
  std::unique_ptr<Light> (*make)(const LightSettings& settings, const LightContext& context);
};

std::span<const LightKind> light_table();

// Factories; each throws InputError for settings that no light can have.
std::unique_ptr<Light> make_distant_light(const LightSettings&, const LightContext&);
std::unique_ptr<Light> make_point_light(const LightSettings&, const LightContext&);
std::unique_ptr<Light> make_spot_light(const LightSettings&, const LightContext&);
std::unique_ptr<Light> make_environment_light(const LightSettings&, const LightContext&);
std::unique_ptr<Light> make_sky_light(const LightSettings&, const LightContext&);

/// Mean flux of photons from a fixed stream, for lights whose power has no short formula.
Rgb estimate_power(const Light& light);

/// A unit vector; throws InputError, naming the key, where `v` has no direction.
Vec3d unit_direction(const Vec3d& v, const char* key);

} // namespace vdbeam
