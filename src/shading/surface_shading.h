#pragma once

#include "photons/photon_pass.h"
#include "rays/profile_shading.h"
#include "shading/matt_shading.h"
#include "shading/surface_lighting.h"
#include "transport/camera_ray.h"

#include <functional>

namespace vdbeam {

/// Light that the photons of a pass scatter into a ray with this profile, which is not empty.
using GatherAlong =
    std::function<GroupedLight(const CameraRay& ray, const DepthProfile& profile, Rng& rng)>;

/// The surfaces that camera rays meet, for estimators that gather photons.
///
/// Behind mirrors, glass and metal, if they are not very rough, the camera ray goes on, and photons
/// are gathered along each of its segments: light that glass throws into the medium is seen there
/// too. At the first two interfaces of glass it goes both ways, reflected and refracted, from then
/// on one of them at random: the faint reflection of a bright lamp is no matter of chance. At any
/// other surface path tracing goes on (WalkTracer), which finds all light except paths whose first
/// event after the light is specular, glossy or, near lamps, in the medium: caustics and light
/// scattered by fog near lamps, after any number of further bounces. Photons on the surface carry
/// these.
class SurfaceShading {
public:
  /// Requires a world with surfaces.
  SurfaceShading(const EstimatorInput& input, const PhotonPass& photons,
                 const SurfaceLighting& surfaces, GatherAlong gather);

  /// Radiance of the surface at which the camera ray ends: the mean over a few random paths.
  SeenSurface seen(const CameraRay& camera, const RngKey& key, std::size_t stream,
                   RenderStatistics& counts) const;

  const MattShading& matt() const { return matt_; }

private:
  struct Chain;

  template <class PathRng>
  SeenSurface shown_by(const SurfaceVertex& vertex, const PathRng& path_rng,
                       RenderStatistics& counts) const;
  template <class PathRng>
  SeenSurface shown_one_way(const SurfaceVertex& vertex, const PathRng& path_rng,
                            RenderStatistics& counts) const;
  template <class PathRng>
  GroupedLight shown_by_frosted(const SurfaceVertex& vertex, const PathRng& path_rng,
                                RenderStatistics& counts) const;
  GroupedLight lamps_behind(const SurfaceVertex& vertex, Rng& rng) const;
  GroupedLight scatter(const SurfaceVertex& vertex, Chain& chain) const;
  GroupedLight follow(Chain chain) const;
  Rgb left_of_lamps(const DepthProfile& profile) const;
  GroupedLight along(const CameraRay& ray, const DepthProfile& profile, const Rgb& tr,
                     Chain& chain) const;
  GroupedLight at_end(const SurfaceVertex& vertex, const Rgb& lamps, Chain& chain) const;
  bool sampled_too(std::size_t light, const Chain& chain) const;
  GroupedLight in_scattered(const CameraRay& ray, const DepthProfile& profile, Rng& rng,
                            RenderStatistics& counts) const;

  const EstimatorInput& input_;
  const World& world_; ///< of the map, perhaps without forward peaks
  const PhotonPass& photons_;
  GatherAlong gather_;
  const SurfaceLighting& surfaces_;
  MattShading matt_;
  float cutoff_;
};

} // namespace vdbeam
