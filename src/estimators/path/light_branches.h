#pragma once

#include "transport/world.h"

#include <optional>
#include <vector>

namespace vdbeam {

/// Where walks of the path tracer branch towards narrow lights.
///
/// Where a phase function has a sharp peak and a light is narrow, a walk that happens to fly at the
/// light scatters all of its peak: next-event estimation then has rare, very bright values. So at
/// each scattering a walk now and then sends a branch of its own in a direction drawn by the phase
/// function about the light's direction instead of its own. With p the density of the walk's own
/// direction and c q that of branches, both carry p/(p + c q), which leaves the mean as it is:
/// flights at the light become many and faint (docs/theory/transport.md, "The reference").
///
/// This is the idea of DXTRAN in neutron transport (X-5 Monte Carlo Team, *MCNP: A General Monte
/// Carlo N-Particle Transport Code*, 2003), for directions in place of a region.
class LightBranches {
public:
  /// `shadow_rays`: per light, whether next-event estimation samples it. The world's medium must
  /// outlive this.
  LightBranches(const World& world, const std::vector<bool>& shadow_rays);

  bool any() const { return !towards_.empty(); }

  /// Whether some phase function scatters so much straight on that branches are worth their time.
  static bool has_sharp_peak(const Medium& medium);

  /// The direction of a branch at a scattering by this phase function of the world's; none where
  /// the walk does not branch.
  std::optional<Vec3f> sample(const PhaseFunction& phase, Rng& rng) const;
  /// c q, the density of branches [1/sr], 0 for directions that are not about a light.
  float density(const PhaseFunction& phase, const Vec3f& direction) const;

  /// Expected contribution of a flight in this direction, in units of one far from narrow lights:
  /// roulette looks at it, or it would end the faint walks that branches are made for.
  float importance(const Vec3f& direction) const;

private:
  float chance(const PhaseFunction& phase) const;

  std::vector<Vec3f> towards_;               ///< the narrow lights
  std::vector<const PhaseFunction*> peaked_; ///< the world's phase functions with a sharp peak
};

} // namespace vdbeam
