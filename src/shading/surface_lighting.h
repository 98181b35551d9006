#pragma once

#include "photonmap/photon_map.h"
#include "rays/estimator_input.h"
#include "walks/walk_tracer.h"

namespace vdbeam {

/// The light of surfaces that are not mirrors, for estimators that gather photons: by path tracing
/// (WalkTracer), but for caustics and the like, which photons on the surfaces bring where the plan
/// has them (Stage::surface_photons).
class SurfaceLighting {
public:
  /// `world`: in which paths are traced; `photons`: those that lie on its surfaces, null: paths
  /// find what they find. What is given must outlive this.
  SurfaceLighting(const EstimatorInput& input, const World& world, const PhotonMap* photons);

  const WalkTracer& tracer() const { return tracer_; }

  /// Radiance that leaves the surface against `direction`, along which a ray meets it, but for what
  /// the surface itself emits.
  GroupedLight reflected(const SurfaceVertex& vertex, const Vec3f& direction, Rng& rng) const;

  /// The two parts of it.
  ReflectedLight by_paths(const SurfaceVertex& vertex, Rng& rng) const;
  GroupedLight by_photons(const SurfaceVertex& vertex, Rng& rng) const;
  /// The light of a shadow catcher that the plate does not have.
  GroupedLight added_to_plate(const SurfaceVertex& vertex, const Vec3f& direction, Rng& rng) const;

  /// Photons bring light to the surface, which it spreads.
  bool shows_photons(const SurfaceVertex& vertex) const {
    return photons_ && vertex.material().takes_photons();
  }

private:
  const World& world_;
  const PhotonMap* photons_;
  WalkTracer tracer_;
};

} // namespace vdbeam
