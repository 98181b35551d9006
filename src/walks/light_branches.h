#pragma once

#include "transport/world.h"
#include "walks/lamp_directions.h"

#include <optional>
#include <vector>

namespace vdbeam {

/// Where walks of the path tracer branch towards narrow lights: suns, lamps and spots.
///
/// Where a phase function has a sharp peak and a light is narrow, a walk that happens to fly at the
/// light scatters all of its peak: next-event estimation then has rare, very bright values. A
/// flight that passes a lamp in the medium at the distance D has a value of about 1 / D, whatever
/// the phase function (LampShells). So at each scattering a walk now and then sends a branch of its
/// own in a direction about the light's instead of its own. With p the density of the walk's own
/// direction and c q that of branches, both carry p/(p + c q), which leaves the mean as it is:
/// flights at the light become many and faint (docs/theory/transport.md, "Path tracing").
/// q is the phase function about the light's direction or, for lamps in the medium, that of
/// LampDirections.
///
/// This is the idea of DXTRAN in neutron transport (X-5 Monte Carlo Team, *MCNP: A General Monte
/// Carlo N-Particle Transport Code*, 2003), for directions in place of a region.
class LightBranches {
public:
  /// `shadow_rays`: per light, whether next-event estimation samples it. `world` must outlive this.
  LightBranches(const World& world, const std::vector<bool>& shadow_rays, const LampShells& shells);

  bool any() const { return !lights_.empty(); }
  /// Some follow a sharp peak; otherwise all go towards lamps in the medium.
  bool any_in_peaks() const { return any() && !peaked_.empty(); }

  /// Whether a light fills a small part of the sky, seen from any point.
  static bool is_narrow(const Light& light);
  /// Whether some phase function scatters so much straight on that branches are worth their time.
  static bool has_sharp_peak(const Medium& medium);

  class Vertex;
  /// The lights that branches from this point may go to: the brightest there of many.
  Vertex at(const Vec3f& point) const;
  /// The same for a vertex that keeps its memory.
  void move(Vertex& vertex, const Vec3f& point) const;

private:
  struct NarrowLight {
    const Light* light;
    double reach; ///< distance up to which branches pass the lamp by 1 / D; 0: it has no shell

    double irradiance(const Vec3f& point) const; ///< infinite if the light is
    /// Unit; undefined where a lamp stands.
    Vec3f towards(const Vec3f& point) const;
    bool passed_from(const Vec3f& point) const;
  };
  bool is_peaked(const PhaseFunction& phase) const;

  const Medium& medium_;
  std::vector<NarrowLight> lights_;
  std::vector<const PhaseFunction*> peaked_; ///< the world's phase functions with a sharp peak
};

/// A vertex of a walk, and the lights to which branches from there go.
class LightBranches::Vertex {
public:
  Vertex() = default;

  /// The direction of a branch at a scattering by this phase function of the world's; none where
  /// the walk does not branch.
  std::optional<Vec3f> sample(const PhaseFunction& phase, Rng& rng) const;
  /// c q, the density of branches [1/sr], 0 for directions that are not about a light.
  float density(const PhaseFunction& phase, const Vec3f& direction) const;

  /// Expected contribution of a flight from the vertex in this direction, in units of one far from
  /// narrow lights: roulette looks at it, or it would end the faint walks that branches are made
  /// for.
  float importance(const Vec3f& direction) const;

private:
  friend class LightBranches;
  float density_about(const NarrowLight& light, const PhaseFunction& phase,
                      const Vec3f& direction) const;

  const LightBranches* branches_ = nullptr;
  Vec3f point_;
  std::vector<const NarrowLight*> lights_; ///< none: no branches go out
};

inline LightBranches::Vertex LightBranches::at(const Vec3f& point) const {
  Vertex vertex;
  move(vertex, point);
  return vertex;
}

} // namespace vdbeam
