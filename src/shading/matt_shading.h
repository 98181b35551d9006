#pragma once

#include "photons/photon_plan.h"
#include "rays/profile_shading.h"
#include "shading/surface_lighting.h"

namespace vdbeam {

/// The light of a surface can be divided by its colour: no channel is too dark to show what light
/// there is.
bool shows_light(const Rgb& color);
/// Says where the surface lies, so that its light can be fitted over pixels.
void locate(const SurfaceVertex& vertex, SeenSurface& seen);

/// The light of surfaces at the ends of camera rays, but for those that show a picture of their
/// surroundings: by paths that go on from there, by shadow rays, and by photons that lie on them.
/// The light of the matt part of the material is kept apart from that of the rest, since it changes
/// slowly over a surface.
class MattShading {
public:
  /// What is given must outlive this.
  MattShading(const World& world, const PhotonPlan& plan, const SurfaceLighting& surfaces);

  /// From few samples; `vertex` shows neither mirror, glass nor polished metal.
  SeenSurface seen(const SurfaceVertex& vertex, const RngKey& key, std::size_t stream) const;
  /// Adds samples to what `seen` found at the end of a ray.
  void add(const CameraRay& camera, const MattSamples& more, const RngKey& key, std::size_t stream,
           SeenSurface& seen) const;

private:
  struct Sum;
  void sample(const SurfaceVertex& vertex, const MattSamples& samples, Rng& rng, Sum& sum) const;
  MattSamples fewest(const Sum& sum, bool is_fitted) const;
  GroupedLight lamp_of(const SurfaceVertex& vertex) const;

  const World& world_;
  const PhotonPlan& plan_;
  const SurfaceLighting& surfaces_;
  bool extended_ = false; ///< some light with shadow rays has an extent, so these have noise
};

} // namespace vdbeam
