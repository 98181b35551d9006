#include "plan/plan_needs.h"

#include "lights/light_table.h"
#include "materials/material_table.h"
#include "math/color.h"
#include "phase/phase_function.h"

#include <algorithm>
#include <limits>

namespace vdbeam {
namespace {

void add_volume(const VolumeSettings& volume, const VolumeFacts& facts, PlanNeeds& needs) {
  if (facts.glowing_voxels > 0) {
    needs.glows = true;
    needs.glow_visible = needs.glow_visible || facts.in_view;
    needs.colored =
        needs.colored || !volume.emission.temperature.empty() || !is_grey(volume.emission.color);
  }
  if (facts.empty || !volume.absorbs_or_scatters())
    return;
  needs.medium = true;
  needs.visible = needs.visible || facts.in_view;
  needs.scatters = needs.scatters || max_component(volume.albedo) > 0;
  needs.anisotropic = needs.anisotropic || !PhaseFunction(volume.phase).isotropic();
  needs.chromatic = needs.chromatic || !is_grey(volume.extinction_scale);
  needs.colored =
      needs.colored || needs.chromatic || !is_grey(volume.albedo) || !volume.color_grid.empty();
}

/// Whether single scattering of a light is found by shadow rays. An estimator without photons finds
/// a light that wants none by the scattered rays that leave the scene.
bool takes_shadow_rays(const LightSettings& light, const LightKind& kind,
                       const EstimatorKind& estimator, DirectLight direct) {
  const DirectLight asked = light.direct.value_or(direct);
  if (estimator.shoots_photons() && asked != DirectLight::automatic)
    return asked == DirectLight::sampled;
  return kind.wants_shadow_rays(light);
}

void add_light(const LightSettings& light, const EstimatorKind& estimator, DirectLight direct,
               PlanNeeds& needs) {
  const LightKind& kind = light_kind(light.type);
  needs.surrounded = needs.surrounded || kind.surrounds;
  needs.colored = needs.colored || light.kelvin || kind.colored(light);
  needs.shadow_ray_lights.push_back(takes_shadow_rays(light, kind, estimator, direct));
}

/// Surfaces that shine are lights too, which come after those of the scene.
void add_surface(const SurfaceSettings& surface, const EstimatorKind& estimator, DirectLight direct,
                 PlanNeeds& needs) {
  const MaterialKind& kind = material_kind(surface.material.type);
  const std::unique_ptr<Material> material = kind.make(surface.material, 1);
  needs.colored = needs.colored || kind.colored(surface.material);
  needs.specular = needs.specular || (material->is_specular() && !material->is_black());
  needs.throws_light = needs.throws_light || material->throws_light();
  needs.receiver = needs.receiver || material->takes_photons();
  if (material->shines())
    needs.shadow_ray_lights.push_back(!estimator.shoots_photons() ||
                                      direct != DirectLight::photons);
}

/// Light comes to surfaces in ways that paths from there find rarely: by mirrors, metal and glass,
/// or by a medium that a lamp stands in or near to. From a constant sky paths find all.
bool bring_light(const Scene& scene, const PlanNeeds& needs) {
  bool lamps = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                           [](const SurfaceSettings& s) { return shines(s.material); });
  bool sampled = lamps;
  for (const LightSettings& light : scene.lights) {
    lamps = lamps || light.type == LightType::point || light.type == LightType::spot;
    sampled = sampled || light_kind(light.type).wants_shadow_rays(light);
  }
  return (needs.throws_light && sampled) || (needs.scatters && lamps);
}

} // namespace

bool PlanNeeds::shadow_rays() const {
  return scatters && std::find(shadow_ray_lights.begin(), shadow_ray_lights.end(), true) !=
                         shadow_ray_lights.end();
}

PlanNeeds find_needs(const Scene& scene, const std::vector<VolumeFacts>& volumes,
                     const EstimatorKind& estimator) {
  PlanNeeds needs;
  for (std::size_t i = 0; i < scene.volumes.size(); ++i)
    add_volume(scene.volumes[i], volumes[i], needs);
  for (const LightSettings& light : scene.lights)
    add_light(light, estimator, scene.render.direct, needs);
  for (const SurfaceSettings& surface : scene.surfaces)
    add_surface(surface, estimator, scene.render.direct, needs);
  // It may be seen in a mirror, or by what it does to the light on surfaces.
  needs.visible = needs.visible || (needs.medium && !scene.surfaces.empty());
  const int bounces = scene.render.max_bounces.value_or(std::numeric_limits<int>::max());
  const bool lit = !needs.shadow_ray_lights.empty() || needs.glows;
  needs.scatters = needs.scatters && needs.visible && lit && bounces > 0;
  // No shadow ray looks for what glows, nor for light that surfaces send on: photons bring it.
  const bool first_flight =
      needs.glows || !scene.surfaces.empty() ||
      std::find(needs.shadow_ray_lights.begin(), needs.shadow_ray_lights.end(), false) !=
          needs.shadow_ray_lights.end();
  needs.surface_photons = estimator.shoots_photons() && needs.receiver && bring_light(scene, needs);
  needs.photons = estimator.shoots_photons() && needs.scatters && (bounces > 1 || first_flight);
  return needs;
}

} // namespace vdbeam
