#pragma once

#include "estimators/camera_ray.h"
#include "estimators/photon_pass.h"
#include "estimators/profile_shading.h"
#include "estimators/scene_tracer.h"

#include <functional>

namespace vdbeam {

/// What the photons of a pass scatter into a ray with this profile, which is not empty.
using GatherAlong = std::function<Rgb(const CameraRay& ray, const DepthProfile& profile, Rng& rng)>;

/// The surfaces that camera rays meet, for estimators that gather photons.
///
/// Behind mirrors and smooth glass the camera ray goes on, reflected or refracted at random, and
/// photons are gathered along each of its segments: light that glass throws into the medium is seen
/// there too. At any other surface path tracing goes on (SceneTracer), which finds all of its light
/// but what mirrors, glass or the medium, met first of all, send on from lights: caustics, the glow
/// of fog about a lamp, and whatever becomes of them. Photons that lie on the surface bring these.
class SurfaceShading {
public:
  /// Requires a world with surfaces.
  SurfaceShading(const EstimatorInput& input, const PhotonPass& photons, GatherAlong gather);

  /// What is seen of the surface at which the camera ray ends: the mean over a few random paths.
  SeenSurface seen(const CameraRay& camera, const RngKey& key, std::size_t pixel,
                   RenderStatistics& counts) const;

private:
  /// Photons bring light to the surface, which it spreads.
  bool shows_photons(const SurfaceVertex& vertex) const {
    return photons_on_surfaces_ && vertex.material().takes_photons();
  }
  Rgb follow(SurfaceHit hit, Vec3f direction, Rng& rng, RenderStatistics& counts) const;
  Rgb in_scattered(const CameraRay& ray, const DepthProfile& profile, Rng& rng,
                   RenderStatistics& counts) const;

  const World& world_;
  const PhotonPass& photons_;
  GatherAlong gather_;
  SceneTracer tracer_;
  bool photons_on_surfaces_;
  float cutoff_;
};

} // namespace vdbeam
