#pragma once

#include "estimators/path/light_branches.h"
#include "medium/flight.h"
#include "medium/optical_depth.h"
#include "transport/world.h"

#include <optional>

namespace vdbeam {

/// The state of a camera path after its first scattering event: it is at a tentative collision of
/// its flight or, while there is one, of its shadow ray.
struct PathWalk : Flight {
  using Flight::Flight;

  std::size_t target = 0;               ///< pixel of the image to which its light is added
  float least_weight = 0;               ///< under which Russian roulette begins
  std::size_t piece = 0;                ///< of the pixel's deep layout in which it began
  std::size_t volume = 0;               ///< of the scene, that scatters its light to the camera
  const PhaseFunction* phase = nullptr; ///< at the last real collision
  bool scatters = true;                 ///< there, in the next step
  float density = 0;       ///< of flights in this one's direction, branches among them [1/sr]
  float gathered = 0;      ///< distance of the flight up to which light that it meets was added
  int null_collisions = 0; ///< of this flight
  Rgb direct, indirect;    ///< light so far that was scattered once, and more often
  std::optional<RatioTracking> shadow;
  std::size_t light = 0; ///< that the shadow ray is sent to
  Rgb shadow_value;      ///< its contribution, without the transmittance
};

/// Walks of the path tracer, a collision at a time: flights by delta tracking (spectral tracking
/// where the extinction is chromatic, Kutz et al. 2017), next-event estimation by ratio tracking at
/// every collision, multiple importance sampling for lights that a scattered ray can meet (balance
/// heuristic, Veach and Guibas 1995), Russian roulette. The medium's own emission is added along
/// every flight up to its end (track-length estimator). Walks branch towards narrow lights where
/// phase functions have a sharp peak (LightBranches).
class WalkTracer {
public:
  /// `shadow_rays`: per light, whether next-event estimation samples it. `max_bounces`: scattering
  /// events of a light path; absent: no limit.
  WalkTracer(const World& world, std::vector<bool> shadow_rays, std::optional<int> max_bounces)
      : world_(world), shadow_rays_(std::move(shadow_rays)), max_bounces_(max_bounces),
        meets_light_(!world.medium.emitters.empty() || world.lights.any_extent()),
        light_branches_(world, shadow_rays_) {}

  /// A walk that scatters first at ray.origin, coming along ray.direction. The light there by
  /// shadow rays is estimated elsewhere (direct_light), so the walk begins with what comes after.
  PathWalk start(std::size_t target, const Rng& rng, const Ray& ray, const Rgb& throughput,
                 const PhaseFunction& phase) const;

  /// Handles the walk's collision and advances to the next one. False where the walk has ended. A
  /// step ends with a prefetch: callers interleave several walks to hide the memory latency.
  /// Branches of the walk are put to `branches`, to be stepped like any other.
  bool step(PathWalk& walk, std::vector<PathWalk>& branches) const;

  // What happens at the collisions of a flight (step_flight).
  void meet(PathWalk& walk, const Collision& hit) const;
  bool pass(PathWalk& walk) const {
    ++walk.null_collisions;
    return true;
  }
  bool collide(PathWalk& walk, const Collision& hit) const;
  bool leave(PathWalk& walk) const;

private:
  void sample_lights(PathWalk& walk) const;
  bool end_flight(PathWalk& walk) const;
  void branch(PathWalk& walk, std::vector<PathWalk>& branches) const;
  bool begin_flight(PathWalk& walk, const Vec3f& direction) const;
  bool outlives_roulette(PathWalk& walk) const;
  float flight_density(const PathWalk& walk, const Vec3f& direction) const;
  void gather_light(PathWalk& walk, float t_end) const;
  Rgb lights_met(const PathWalk& walk, const Segment& segment) const;

  const World& world_;
  std::vector<bool> shadow_rays_;
  std::optional<int> max_bounces_;
  bool meets_light_; ///< flights may meet light before they end
  LightBranches light_branches_;
};

} // namespace vdbeam
