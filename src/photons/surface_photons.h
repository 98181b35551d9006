#pragma once

#include "math/grouped_light.h"
#include "photonmap/photon_map.h"
#include "transport/surfaces.h"

namespace vdbeam {

/// Estimate of the light at a point of a surface from the photons on it.
///
/// Photons count that lie in the disc about the point, in the surface's tangent plane but for a
/// tenth of their radius. Their sum is divided by the share of that disc in which photons can lie:
/// by rays, which find where the surface ends and where others stand on it. So even light is even
/// up to edges and corners, whatever the radii.
class SurfacePhotons {
public:
  SurfacePhotons(const Surfaces& surfaces, const PhotonMap& map) : surfaces_(surfaces), map_(map) {}

  /// The light that leaves against the direction in which the path came.
  GroupedLight reflected(const SurfaceVertex& vertex, Rng& rng) const;

private:
  struct Disc;
  bool sees(const Disc& disc, const Vec3d& point) const;
  bool on_surface(const Disc& disc, const Vec3d& point) const;
  float share(Disc& disc, Rng& rng) const;

  const Surfaces& surfaces_;
  const PhotonMap& map_;
};

} // namespace vdbeam
