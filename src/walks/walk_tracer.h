#pragma once

#include "math/grouped_light.h"
#include "medium/optical_depth.h"
#include "transport/light_draw.h"
#include "transport/world.h"
#include "tuning/constants.h"
#include "walks/camera_walk.h"
#include "walks/lamp_shells.h"
#include "walks/light_branches.h"

#include <optional>

namespace vdbeam {

/// Work of walks.
struct WalkCounts {
  std::uint64_t steps = 0;       ///< at tentative collisions of flights and of shadow rays
  std::uint64_t shadow_rays = 0; ///< begun, hidden ones among them
};

/// The state of a path from the camera on: it is at a tentative collision of its flight or, while
/// there is one, of its shadow ray.
struct PathWalk : CameraWalk {
  using CameraWalk::CameraWalk;

  std::size_t target = 0; ///< pixel of the image to which its light is added
  std::size_t piece = 0;  ///< of the pixel's deep layout in which it began
  std::size_t volume = 0; ///< of the scene, that scatters its light to the camera
  float share = 1;        ///< what its light counts in the pixel

  float least_weight = tuning::roulette_below; ///< under which Russian roulette begins
  const PhaseFunction* phase = nullptr;        ///< at the last real collision
  bool scatters = false;                       ///< there, in the next step
  /// Density of flights in this one's direction, branches among them [1/sr]; 0: nothing else draws
  /// it.
  float density = 0;
  LightBranches::Vertex vertex; ///< the last in the medium, where branches begin
  /// Light so far that the medium scattered once at most, and more often.
  GroupedLight direct, indirect;
  std::optional<RatioTracking> shadow;
  std::vector<DrawnLight> lights; ///< for shadow rays from the collision
  std::size_t light = 0;          ///< of these, the one that the shadow ray is sent to
  Rgb shadow_value;               ///< its contribution, without the transmittance
  std::uint64_t shadow_rays = 0;  ///< so far, those of the present vertex among them

  // Weights of light that comes unscattered from lights with shadow rays:
  bool skips_sampled = false; ///< none on this flight, since it was found before
  bool all_light = true;      ///< else only that which surfaces get straight from lights
  bool from_surface = false;  ///< the present flight begins at such a surface
  bool from_medium = false;   ///< or in the medium
  /// It has met nothing but shadow catchers: the light of the plate's lights is in the plate.
  bool in_plate = false;

  float refraction = 1; ///< factor of the throughput that is no loss: roulette looks beyond it

  bool leaves_out(const Light& source) const {
    return skips_sampled || (!all_light && !from_surface && (source.is_near() || !from_medium));
  }
  void add(const GroupedLight& radiance) { (bounces > 1 ? indirect : direct) += radiance; }
  void add(const Rgb& radiance, int group) {
    (bounces > 1 ? indirect : direct).add(radiance, group);
  }
};

/// Light that a surface reflects, by what brings it and by the part of the material that reflects
/// it (Material::matt).
struct ReflectedLight {
  struct Parts {
    GroupedLight matt, gloss;
  };
  Parts straight; ///< that shadow rays from the surface find
  Parts beyond;   ///< by way of other surfaces and the medium
};

/// Unbiased path tracing in media and among surfaces, a collision at a time: flights by delta
/// tracking end at surfaces, which scatter by their materials; next-event estimation at every
/// vertex that is not specular (sample_direct_light), through the medium by ratio tracking,
/// combined with the directions drawn by multiple importance sampling; Russian roulette. The
/// medium's own emission is added along every flight up to its end (track-length estimator). Walks
/// branch towards narrow lights where phase functions have a sharp peak (LightBranches). Light of
/// point lights, or of a parallel sun, that only mirrors or glass bring to a point is not found: no
/// path meets them.
class WalkTracer {
public:
  /// `shadow_rays`: per light, whether next-event estimation samples it. `max_bounces`: scattering
  /// events of a light path in the medium; absent: no limit.
  WalkTracer(const World& world, std::vector<bool> shadow_rays, std::optional<int> max_bounces)
      : world_(world), shadow_rays_(std::move(shadow_rays)), max_bounces_(max_bounces),
        meets_light_(!world.medium.emitters.empty() || world.lights.any_extent()),
        light_draw_(world.lights, shadow_rays_), shells_(world, shadow_rays_),
        light_branches_(world, shadow_rays_, shells_) {}

  /// A walk that scatters first at ray.origin, coming along ray.direction. The light there by
  /// shadow rays is estimated elsewhere (direct_light), so the walk begins with what comes after.
  PathWalk start(std::size_t target, const Rng& rng, const Ray& ray, const Rgb& throughput,
                 const PhaseFunction& phase) const;

  /// Radiance that leaves a surface against `direction`, along which a ray meets it.
  /// `all_light`: or without what a light with shadow rays sends first to mirrors, metal, glass or,
  /// if it is near, the medium, and they on to other surfaces, to which photons bring it.
  /// `emits`: with what the surface itself emits. `counts`, unless it is null, gets the walks' work
  /// added.
  GroupedLight from_surface(const SurfaceHit& hit, const Vec3f& direction, Rng& rng,
                            bool all_light = true, bool emits = true,
                            WalkCounts* counts = nullptr) const;
  /// The same, without what the surface emits, by parts.
  ReflectedLight reflected(const SurfaceVertex& vertex, Rng& rng, bool all_light) const;

  /// Radiance that leaves a shadow catcher against `direction` by light that the plate which it
  /// stands for does not have: light of surfaces that shine, of glowing volumes, and light of the
  /// others that comes by way of the medium and of other surfaces.
  GroupedLight added_to_plate(const SurfaceHit& hit, const Vec3f& direction, Rng& rng,
                              bool all_light) const;

  /// Next-event estimation at a surface that is not specular: what it reflects of the lights with
  /// shadow rays, weighted against the direction that `vertex` draws or, if it goes on as a walk of
  /// this tracer does, the walk. `matt`, unless it is null, gets the part that the matt part of the
  /// material reflects.
  GroupedLight lights_at_surface(const SurfaceVertex& vertex, Rng& rng,
                                 bool goes_on_as_walk = false, bool in_plate = false,
                                 GroupedLight* matt = nullptr) const;
  bool samples_light(std::size_t light) const { return shadow_rays_[light]; }

  /// Handles the walk's collision and advances to the next one. False where the walk has ended. A
  /// step ends with a prefetch: callers interleave several walks to hide the memory latency.
  /// Branches of the walk are put to `branches`, to be stepped like any other.
  bool step(PathWalk& walk, std::vector<PathWalk>& branches) const;

  // What happens at the collisions of a flight (step_flight).
  static constexpr bool bounds_null_collisions = true;
  void meet(PathWalk& walk, const Collision& hit) const;
  bool pass(PathWalk&) const { return true; }
  bool collide(PathWalk& walk, const Collision& hit) const;
  bool leave(PathWalk& walk) const;

private:
  GroupedLight follow_from(const SurfaceVertex& vertex, PathWalk& first, WalkCounts* counts) const;
  GroupedLight follow(PathWalk& first, bool leaves, WalkCounts* counts) const;
  float roulette_from(const Rgb& throughput) const;
  void sample_lights(PathWalk& walk) const;
  void branch(PathWalk& walk, std::vector<PathWalk>& branches) const;
  void set_out(PathWalk& walk, const Vec3d& origin, const Vec3f& direction) const;
  void look_into_shells(PathWalk& walk) const;
  bool scatter(PathWalk& walk, const Vec3f& direction) const;
  bool meet_surface(PathWalk& walk) const;
  bool bounce(PathWalk& walk, const SurfaceVertex& vertex, bool is_first,
              GroupedLight* matt = nullptr) const;
  bool looks_for_emission(const SurfaceVertex& vertex) const;
  float surface_density(const SurfaceVertex& vertex, const Vec3f& wi) const;
  MaterialSample leave_surface(const SurfaceVertex& vertex, Rng& rng) const;
  bool outlives_roulette(PathWalk& walk) const;
  float flight_density(const PathWalk& walk, const Vec3f& direction) const;
  void gather_light(PathWalk& walk, float medium_end, float t_end) const;
  float weight_of_met(const PathWalk& walk, std::size_t light) const;

  const World& world_;
  std::vector<bool> shadow_rays_;
  std::optional<int> max_bounces_;
  bool meets_light_; ///< flights may meet light before they end
  LightDraw light_draw_;
  LampShells shells_;
  LightBranches light_branches_;
};

} // namespace vdbeam
