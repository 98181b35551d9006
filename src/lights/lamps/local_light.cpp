#include "lights/lamps/local_light.h"

namespace vdbeam {
namespace {

// Nearer than this (render units: the region's size is about 1) the light is no point any more; the
// limit keeps intensity / distance^2 finite.
constexpr double nearest = 1e-6;

} // namespace

LocalLight::LocalLight(const LightSettings& settings, const LightContext& context,
                       const Cone& emission_cone)
    : position_(render_position(settings, context)),
      // W/sr seen over areas that grow with scale^2 keeps irradiance the same.
      intensity_(Vec3d(settings.intensity) * (context.space.scale * context.space.scale)),
      cone_(emission_cone) {
  sphere_.center = context.region.center;
  sphere_.radius = context.region.boxes.empty() ? -1 : context.region.radius;
}

IncidentSample LocalLight::sample_incident(const Vec3f& point, float, float) const {
  const Vec3d to = position_ - Vec3d(point);
  const double distance = length(to);
  if (!(distance > 0))
    return {{0, 0, 1}, 0, {}, 0};
  const Vec3d wi = to / distance;
  const double clamped = std::max(distance, nearest);
  const Vec3d factor = share(-wi) / (clamped * clamped);
  return {Vec3f(wi), static_cast<float>(distance), Rgb(intensity_ * factor), 0};
}

LocalLight::Drawn LocalLight::draw(double place, float v) const {
  return {cone_.sample(static_cast<float>(place), v), cone_.solid_angle()};
}

EmittedPhoton LocalLight::emit(double place, Rng& rng) const {
  const auto [direction, solid_angle] = draw(place, rng.uniform());
  Vec3d origin;
  if (sphere_.radius < 0 || !advance_to_region(position_, direction, sphere_, origin))
    return {{Vec3f(position_), Vec3f(direction)}, {}};
  const Vec3d factor = share(direction) * solid_angle;
  return {{Vec3f(origin), Vec3f(direction)}, Rgb(intensity_ * factor)};
}

} // namespace vdbeam
