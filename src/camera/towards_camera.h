#pragma once

#include "camera/camera.h"
#include "medium/medium.h"

namespace vdbeam {

/// How much of what travels along `direction` at `position` a volume of the medium scatters towards
/// the camera, relative to isotropic scattering: 4 pi p(cos), whose mean over all directions is 1.
/// At least 1/5, so that no photon weighs much more than others at its place where rays meet it
/// from elsewhere, by way of a mirror for instance.
inline float towards_camera(const Camera& camera, const Medium& medium, const Volume& volume,
                            const Vec3f& position, const Vec3f& direction) {
  constexpr float least = 0.2f;
  const PhaseFunction& phase =
      medium.gathered_phases()[static_cast<std::size_t>(volume.phase_index)];
  const Vec3f ray(camera.direction_towards(Vec3d(position)));
  return std::max(least, 4 * pi * phase.evaluate(-dot(direction, ray)));
}

} // namespace vdbeam
