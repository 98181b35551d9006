#pragma once

#include "photons/kernel_support.h"
#include "photons/photon_cache.h"
#include "photons/photon_plan.h"
#include "rays/direct_light.h"
#include "transport/similar_medium.h"
#include "vdbeam/pass_spec.h"

namespace vdbeam {

/// The photon side of a pass, for estimators that gather photons: traces them by a plan, builds
/// their map (or takes it over from another frame) and corrects kernels at the medium's boundary.
class PhotonPass {
public:
  /// `worlds`: of the input's world; `first`: the one of them in which the plan was made. All must
  /// outlive this.
  PhotonPass(const EstimatorInput& input, PassWorlds& worlds, const World& first,
             const PhotonPlan& plan);

  /// Makes the map of a pass. `domain`: what its kernels are normalised over. Throws Stopped where
  /// the input's `stop` says so.
  void trace_and_build(const PassSpec& spec, KernelDomain domain, RenderStatistics& statistics);

  /// Drops the map until the next pass: where passes see different worlds, each has its own.
  void release() {
    maps_ = {};
    compared_map_ = {};
    caustics_along_rays_ = {};
  }

  /// Rays of the lattices of shadows for each pixel. One lattice for many passes costs little; that
  /// of a moment of the shutter may serve a single pass.
  static double shadow_rays_per_pixel(bool of_moment);

  const PhotonPlan& plan() const { return plan_; }
  /// Shadow lattices that place shadow rays; empty if they cannot.
  const ShadowLattices& shadows() const { return shadows_; }
  const PhotonMap& map() const { return maps_.medium; }
  /// The same photons in kernels of another width (BlurProbe); empty where nobody asked for the
  /// blur.
  const PhotonMap& compared_map() const { return compared_map_; }
  /// Those photons of the map that mirrors and glass brought unscattered, for passes whose walks
  /// leave their light out (caustic_lights): for walks, and for rays, whose kernels are normalised
  /// otherwise.
  const PhotonMap& caustics() const { return maps_.caustics; }
  const PhotonMap& caustics_along_rays() const { return caustics_along_rays_; }
  /// Photons on surfaces: what mirrors, glass and the medium send on to them.
  const PhotonMap& surface_map() const { return maps_.surfaces; }
  /// In which the photons of the map live: the scene's world, or one without its forward peak.
  const World& world() const { return *world_; }

private:
  void make_maps(const PassSpec& spec, const RadiusSettings& radii, RenderStatistics& statistics);

  EstimatorInput input_;
  PassWorlds& worlds_;
  const World* world_; ///< of the pass at hand
  const PhotonPlan& plan_;
  ShadowLattices shadows_;
  PhotonMaps maps_;
  PhotonMap compared_map_, caustics_along_rays_;
};

} // namespace vdbeam
