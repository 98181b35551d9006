#pragma once

#include "transport/optical_depth.h"
#include "transport/scattering.h"
#include "transport/world.h"

#include <optional>

namespace vdbeam {

/// A path after its first scattering, under way: it stands at a tentative collision of its flight
/// or, while there is one, of its shadow ray.
struct PathWalk {
  std::size_t target; ///< pixel of the image that its light goes to
  Rng rng;
  Ray ray;
  Rgb throughput;
  int bounces;
  float phase_pdf; ///< of ray.direction
  std::optional<MediumTracker> flight;
  float gathered; ///< distance of the flight up to which the medium's own light was taken in
  LengthRoulette length;
  const PhaseFunction* phase; ///< at the last collision
  Rgb direct, indirect;       ///< found so far: light that was scattered once, and more often
  std::optional<RatioTracking> shadow;
  std::size_t light; ///< to which the shadow ray goes
  Rgb shadow_value;  ///< what comes along it, were nothing in the way
};

/// Walks of the path tracer, a collision at a time: flights by delta tracking (spectral tracking
/// where the extinction is chromatic, Kutz et al. 2017), next-event estimation by ratio tracking at
/// every collision, multiple importance sampling for lights that a scattered ray can meet (balance
/// heuristic, Veach and Guibas 1995), Russian roulette. The medium's own light is gathered along
/// every flight as far as it goes (track-length estimator).
class WalkTracer {
public:
  /// `shadow_rays`: per light, whether next-event estimation finds it.
  WalkTracer(const World& world, std::vector<bool> shadow_rays)
      : world_(world), shadow_rays_(std::move(shadow_rays)),
        glows_(!world.medium.emitters.empty()) {}

  /// A walk that scatters first at ray.origin, coming along ray.direction. The light there by
  /// shadow rays is estimated elsewhere (direct_light), so the walk begins with what comes after.
  PathWalk start(std::size_t target, const Rng& rng, const Ray& ray, const Rgb& throughput,
                 const PhaseFunction& phase) const;

  /// Does what the walk's collision asks for and goes to the next one. False where it has ended.
  /// Between two steps memory has time to deliver: callers with several walks let them take turns.
  bool step(PathWalk& walk) const;

private:
  bool shine(PathWalk& walk) const;
  void turn(PathWalk& walk) const;
  bool fly(PathWalk& walk) const;
  void gather_emission(PathWalk& walk, float t_end) const;
  Rgb escape(const PathWalk& walk) const;

  const World& world_;
  std::vector<bool> shadow_rays_;
  bool glows_;
};

} // namespace vdbeam
