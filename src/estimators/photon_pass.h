#pragma once

#include "estimators/direct_light.h"
#include "estimators/kernel_support.h"
#include "estimators/photon_cache.h"
#include "estimators/photon_plan.h"
#include "transport/similar_medium.h"

namespace vdbeam {

/// The photon side of a pass, for estimators that gather photons: traces them by a plan, builds
/// their map (or takes it over from another frame) and corrects kernels at the medium's boundary.
class PhotonPass {
public:
  /// `make_plan`: chooses the plan in the world of the first pass. `domain`: what the estimator's
  /// kernels are normalised over.
  PhotonPass(const EstimatorInput& input, PhotonPlan (*make_plan)(const EstimatorInput&),
             KernelDomain domain);

  /// Makes the map of a pass. Radii shrink from pass to pass.
  void trace_and_build(int pass, RenderStatistics& statistics);

  /// Drops the map until the next pass: where passes see different worlds, each has its own.
  void release() {
    maps_ = {};
    compared_map_ = {};
  }

  /// Rays of the lattices of shadows for each pixel. One lattice for many passes costs little; that
  /// of a moment of the shutter may serve a single pass.
  static double shadow_rays_per_pixel(bool of_moment);

  const PhotonPlan& plan() const { return plan_; }
  /// Tell where direct light is to be looked for; empty where they cannot.
  const ShadowLattices& shadows() const { return shadows_; }
  const PhotonMap& map() const { return maps_.medium; }
  /// The same photons in kernels of another width (BlurProbe); empty where nobody asked for the
  /// blur.
  const PhotonMap& compared_map() const { return compared_map_; }
  /// Photons on surfaces: what mirrors, glass and the medium send on to them.
  const PhotonMap& surface_map() const { return maps_.surfaces; }
  /// In which the photons of the map live: the scene's world, or one without its forward peak.
  const World& world() const { return *world_; }

private:
  void make_maps(int pass, const RadiusSettings& radii, RenderStatistics& statistics);
  void count_pilot(RenderStatistics& statistics);

  EstimatorInput input_;
  PassWorlds worlds_;
  const World* world_; ///< of the pass at hand
  PhotonPlan plan_;
  ShadowLattices shadows_;
  KernelShare boundary_share_, final_share_; ///< of the estimator's kernels, and of walks'
  bool pilot_counted_ = false;
  PhotonMaps maps_;
  PhotonMap compared_map_;
};

} // namespace vdbeam
