#pragma once

#include "layers/ray_sink.h"
#include "photons/photon_plan.h"
#include "shading/surface_lighting.h"
#include "walks/lamp_directions.h"

namespace vdbeam {

/// Light gathered by the walks of a camera ray: the mean over the walks.
struct GatheredLight {
  GroupedLight direct;   ///< scattered once, of lights for which there are no shadow rays
  GroupedLight indirect; ///< scattered more often
  Rgb blur; ///< by how much `indirect` exceeds what the same walks gather in other kernels
};

/// Final gathering (Jensen, *Realistic Image Synthesis Using Photon Mapping*, 2001) in a medium:
/// photons are not gathered along the camera ray, but where walks arrive that begin on it. A walk
/// scatters at a point of the ray and goes on until it is a kernel's radius away, with shadow rays
/// at each collision on its way; there the photons' density is what scatters into its last flight.
/// A walk that meets a surface ends there, with the light that the surface sends back, unless it is
/// a mirror or glass. So kernels blur only what walks are about to blur anyway, and most of their
/// bias is gone, for noise of the walks' own (docs/theory/beam.md, "Gather").
class FinalGather {
public:
  /// The photons that walks gather; all must outlive this.
  struct Maps {
    const PhotonMap& photons; ///< as the plan has them
    /// The same in kernels of another width; null where the blur is not asked for.
    const PhotonMap* compared = nullptr;
    /// Those that mirrors and glass brought (caustic_lights); null: there are none. Walks leave out
    /// this light where they scatter first, since it is gathered along the camera ray.
    const PhotonMap* caustics = nullptr;
  };

  /// `surfaces`: light of what walks meet. What is given must outlive this.
  FinalGather(const World& world, const PhotonPlan& plan, const Maps& maps,
              const SurfaceLighting& surfaces);

  /// `walks` walks from the ray, whose profile is not empty, at stratified distances.
  /// `ray_weight`: of the ray among those of its pixel.
  GatheredLight gather(const Ray& ray, const DepthProfile& profile, int walks, float ray_weight,
                       Rng& rng, RenderStatistics& counts, const RaySink& sink = {}) const;

  struct Walk;

  // What happens at the collisions of a flight (step_flight).
  static constexpr bool bounds_null_collisions = true;
  void meet(Walk& walk, const Collision& hit) const;
  bool pass(Walk&) const { return true; }
  bool collide(Walk& walk, const Collision& hit) const;
  bool leave(Walk& walk) const;

private:
  void follow(Walk& walk) const;
  Vec3f draw_direction(const Ray& arriving, int phase_index, bool first, Rng& rng,
                       float& weight) const;
  void set_out(Walk& walk, const Vec3d& origin, const Vec3f& direction,
               bool mirrored = false) const;
  bool finds(const Walk& walk, std::size_t light) const;
  void gather_light(Walk& walk, float medium_end, float t_end) const;
  bool meet_surface(Walk& walk) const;
  void send_shadow_rays(Walk& walk, const PhaseFunction& phase) const;
  void gather_photons(Walk& walk, const Volume& volume, const PhotonMap& map) const;
  /// Distance from its beginning at which a walk that collides in a volume gathers and ends.
  float far_enough(const Volume& volume) const {
    return maps_.photons.mean_radius(world_.medium.part_of(volume));
  }

  const World& world_;
  const PhotonPlan& plan_;
  const Maps maps_;
  const SurfaceLighting& surfaces_;
  const LightDraw light_draw_;
  const LampShells shells_; ///< flights find the light of lamps near by, shadow rays that of others
  const LampDirections lamps_;
  bool meets_light_; ///< flights may meet light before they end
};

} // namespace vdbeam
