#include "estimators/path/light_branches.h"

#include "tuning/constants.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Branches go where the phase function about the light is above its mean: in other directions
/// they would only be copies of the walk.
constexpr float least_about_light = 1 / (4 * pi);

/// q of one light.
float about_light(const PhaseFunction& phase, const Vec3f& towards, const Vec3f& direction) {
  const float value = phase.evaluate(dot(towards, direction));
  return value > least_about_light ? value : 0;
}

bool is_peaked(const PhaseFunction& phase) {
  return 4 * pi * phase.evaluate(1) > tuning::sharp_peak;
}

} // namespace

bool LightBranches::has_sharp_peak(const Medium& medium) {
  return std::any_of(medium.phases.begin(), medium.phases.end(), is_peaked);
}

LightBranches::LightBranches(const World& world, const std::vector<bool>& shadow_rays) {
  for (const PhaseFunction& phase : world.medium.phases)
    if (is_peaked(phase))
      peaked_.push_back(&phase);
  if (peaked_.empty())
    return;
  for (std::size_t i = 0; i < world.lights.size(); ++i)
    if (const Vec3f* towards = world.lights[i].narrow_direction(); towards && shadow_rays[i])
      towards_.push_back(*towards);
}

/// c at a scattering by this phase function.
float LightBranches::chance(const PhaseFunction& phase) const {
  const bool worth = any() && std::find(peaked_.begin(), peaked_.end(), &phase) != peaked_.end();
  return worth ? tuning::branches_per_scattering : 0;
}

std::optional<Vec3f> LightBranches::sample(const PhaseFunction& phase, Rng& rng) const {
  const float c = chance(phase);
  if (c == 0 || rng.uniform() >= c)
    return std::nullopt;
  const auto count = static_cast<float>(towards_.size());
  const auto light = static_cast<std::size_t>(rng.uniform() * count);
  const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
  const Vec3f& towards = towards_[std::min(light, towards_.size() - 1)];
  const Vec3f direction = phase.sample(towards, u_lobe, u, v);
  return about_light(phase, towards, direction) > 0 ? std::optional(direction) : std::nullopt;
}

float LightBranches::density(const PhaseFunction& phase, const Vec3f& direction) const {
  const float c = chance(phase);
  if (c == 0)
    return 0;
  float sum = 0;
  for (const Vec3f& towards : towards_)
    sum += about_light(phase, towards, direction);
  return c * sum / static_cast<float>(towards_.size());
}

float LightBranches::importance(const Vec3f& direction) const {
  float most = 0;
  for (const Vec3f& towards : towards_)
    for (const PhaseFunction* phase : peaked_)
      most = std::max(most, phase->evaluate(dot(towards, direction)));
  return 1 + tuning::importance_of_peak * most;
}

} // namespace vdbeam
