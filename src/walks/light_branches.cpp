#include "walks/light_branches.h"

#include "tuning/constants.h"
#include "walks/brightest.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Branches go where the phase function about the light is above its mean: in other directions
/// they would only be copies of the walk.
constexpr float least_about_light = 1 / (4 * pi);

/// q of a light outside of the medium.
float about_light(const PhaseFunction& phase, const Vec3f& towards, const Vec3f& direction) {
  const float value = phase.evaluate(dot(towards, direction));
  return value > least_about_light ? value : 0;
}

bool has_peak(const PhaseFunction& phase) {
  return 4 * pi * phase.evaluate(1) > tuning::sharp_peak;
}

} // namespace

bool LightBranches::has_sharp_peak(const Medium& medium) {
  return std::any_of(medium.phases.begin(), medium.phases.end(), has_peak);
}

bool LightBranches::is_narrow(const Light& light) {
  return light.narrow_direction() || (light.position() && light.is_delta());
}

Vec3f LightBranches::NarrowLight::towards(const Vec3f& point) const {
  if (const Vec3f* direction = light->narrow_direction())
    return *direction;
  return Vec3f(normalize(*light->position() - Vec3d(point)));
}

double LightBranches::NarrowLight::irradiance(const Vec3f& point) const {
  if (!light->position())
    return std::numeric_limits<double>::infinity();
  const Vec3d to = *light->position() - Vec3d(point);
  return irradiance_from(static_cast<double>(light->typical_intensity()), to);
}

bool LightBranches::NarrowLight::passed_from(const Vec3f& point) const {
  return reach > 0 && length(*light->position() - Vec3d(point)) < reach;
}

LightBranches::LightBranches(const World& world, const std::vector<bool>& shadow_rays,
                             const LampShells& shells)
    : medium_(world.medium) {
  for (const PhaseFunction& phase : world.medium.phases)
    if (has_peak(phase))
      peaked_.push_back(&phase);
  for (std::size_t i = 0; i < world.lights.size(); ++i) {
    const double reach = LampDirections::reach(shells, i);
    if (is_narrow(world.lights[i]) && shadow_rays[i] && (!peaked_.empty() || reach > 0))
      lights_.push_back({&world.lights[i], reach});
  }
}

void LightBranches::move(Vertex& vertex, const Vec3f& point) const {
  if (!any())
    return;
  vertex.branches_ = this;
  vertex.point_ = point;
  find_brightest(
      lights_, [&](const NarrowLight& light) { return light.irradiance(point); }, vertex.lights_);
}

bool LightBranches::is_peaked(const PhaseFunction& phase) const {
  return std::find(peaked_.begin(), peaked_.end(), &phase) != peaked_.end();
}

/// q of one light.
float LightBranches::Vertex::density_about(const NarrowLight& light, const PhaseFunction& phase,
                                           const Vec3f& direction) const {
  const Vec3f to_light = light.towards(point_);
  if (light.passed_from(point_))
    return LampDirections::density_about(branches_->medium_, to_light, direction);
  return branches_->is_peaked(phase) ? about_light(phase, to_light, direction) : 0;
}

std::optional<Vec3f> LightBranches::Vertex::sample(const PhaseFunction& phase, Rng& rng) const {
  if (lights_.empty() || rng.uniform() >= tuning::branches_per_scattering)
    return std::nullopt;
  const float place = rng.uniform() * static_cast<float>(lights_.size());
  const NarrowLight& light =
      *lights_[std::min(static_cast<std::size_t>(place), lights_.size() - 1)];
  const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
  const Vec3f to_light = light.towards(point_);
  if (light.passed_from(point_))
    return LampDirections::sample_about(branches_->medium_, to_light, u, v);
  if (!branches_->is_peaked(phase))
    return std::nullopt;
  const Vec3f direction = phase.sample(to_light, u_lobe, u, v);
  return about_light(phase, to_light, direction) > 0 ? std::optional(direction) : std::nullopt;
}

float LightBranches::Vertex::density(const PhaseFunction& phase, const Vec3f& direction) const {
  if (lights_.empty())
    return 0;
  float sum = 0;
  for (const NarrowLight* light : lights_)
    sum += density_about(*light, phase, direction);
  return tuning::branches_per_scattering * sum / static_cast<float>(lights_.size());
}

float LightBranches::Vertex::importance(const Vec3f& direction) const {
  float most = 0;
  for (const NarrowLight* light : lights_) {
    const Vec3f to_light = light->towards(point_);
    if (light->passed_from(point_))
      most = std::max(most, LampDirections::density_about(branches_->medium_, to_light, direction));
    for (const PhaseFunction* phase : branches_->peaked_)
      most = std::max(most, phase->evaluate(dot(to_light, direction)));
  }
  return 1 + tuning::importance_of_peak * most;
}

} // namespace vdbeam
