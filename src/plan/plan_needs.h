#pragma once

#include "keys/estimator_kind.h"
#include "plan/plan.h"

namespace vdbeam {

/// Properties of the scene that decide the stages.
struct PlanNeeds {
  bool medium = false;          ///< something absorbs or scatters
  bool visible = false;         ///< and the camera sees it
  bool glows = false;           ///< some volume emits
  bool glow_visible = false;    ///< and the camera sees it
  bool scatters = false;        ///< light is scattered towards the camera
  bool photons = false;         ///< photons are gathered
  bool surface_photons = false; ///< photons bring light to surfaces
  bool anisotropic = false;     ///< some phase function depends on the direction
  bool chromatic = false;       ///< extinction differs between channels
  bool colored = false;         ///< some colour is no grey
  bool throws_light = false;    ///< some surface is a mirror, or of metal or glass
  bool specular = false;        ///< some surface is a mirror, or of smooth glass
  bool receiver = false;        ///< some surface is neither, and reflects light
  bool surrounded = false;      ///< some light is met by rays that leave the scene
  std::vector<bool> shadow_ray_lights;

  bool shadow_rays() const;
};

PlanNeeds find_needs(const Scene& scene, const std::vector<VolumeFacts>& volumes,
                     const EstimatorKind& estimator);

} // namespace vdbeam
