#pragma once

#include "lights/light.h"
#include "lights/light_context.h"
#include "text/key_complaint.h"

#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace vdbeam {

/// One kind of light: everything that validation, plan, help and docs ask about it. It stands in
/// the light's own file; the table below lists it.
struct LightKind {
  std::string_view name; ///< as scene files call it
  std::string_view help; ///< one clause
  /// Keys of [[light]] that only this kind, and others that list them, have.
  std::span<const std::string_view> keys;
  bool (*colored)(const LightSettings&); ///< its light is no grey
  bool surrounds = false;                ///< the light comes from all around, as a sky's does
  /// False where scattered rays that escape find the light as well as shadow rays would (a constant
  /// sky), so that none need be spent. Never false for a delta light.
  bool (*wants_shadow_rays)(const LightSettings&) = [](const LightSettings&) { return true; };
  /// What the ranges of single keys cannot say.
  std::optional<KeyComplaint> (*complaint)(const LightSettings&) = [](const LightSettings&) {
    return std::optional<KeyComplaint>();
  };
  /// Throws InputError for settings that no light can have.
  std::unique_ptr<Light> (*make)(const LightSettings& settings, const LightContext& context);
};

/// Every kind of light, in the order of --help. A new one is its file and a line here.
std::span<const LightKind* const> light_table();

/// The kind of a light. Throws InputError for one that is not in the table.
const LightKind& light_kind(const LightType& type);

/// A light's settings with kelvin and exposure multiplied into irradiance, intensity, radiance and
/// power, which leaves none of the two.
LightSettings tinted(LightSettings settings);

/// The light of its kind. Throws InputError for settings that no light can have.
std::unique_ptr<Light> make_light(const LightSettings& settings, const LightContext& context);

extern const LightKind distant_light, point_light, spot_light, environment_light, sky_light,
    atmosphere_light, sun_light;

/// A complaint where the light's direction is 0.
std::optional<KeyComplaint> direction_complaint(const LightSettings& settings);

/// Mean flux of photons from a fixed stream, for lights whose power has no short formula.
Rgb estimate_power(const Light& light, int photons = 4096);

/// A unit vector; throws InputError, naming the key, where `v` has no direction.
Vec3d unit_direction(const Vec3d& v, const char* key);

} // namespace vdbeam
