#pragma once

#include "math/grouped_light.h"
#include "math/rng.h"
#include "transport/world.h"

#include <vector>

namespace vdbeam {

/// Next-event estimation near lamps in the medium, for random walks. The light of a lamp without
/// extent grows as 1 / r^2, whose square has no finite mean over a medium, so shadow rays from the
/// collisions of walks have no bound. In a ball of half a mean free path around each lamp they
/// are left out; instead, each flight that crosses the shell samples one point of the crossing
/// by equal angles about the lamp (EquiAngular), whose density cancels 1 / r^2.
class LampShells {
public:
  /// `sampled`: per light, whether shadow rays look for it. `world` must outlive this.
  LampShells(const World& world, const std::vector<bool>& sampled);

  bool any() const { return !shells_.empty(); }
  /// The radius of the ball around a lamp [render units]; 0 where it has none.
  double radius_of(std::size_t light) const;
  /// Flights find the light of this lamp at the point, and no shadow ray may.
  bool holds(std::size_t light, const Vec3f& point) const;
  /// Light of the lamps that is scattered once, inside of the shells, against the flight: an
  /// unbiased estimate of its radiance at the flight's origin. Adds its shadow rays to
  /// `shadow_rays`.
  GroupedLight along(const Segment& flight, Rng& rng, std::uint64_t& shadow_rays) const;

private:
  struct Shell {
    std::size_t light;
    Vec3d center;
    double radius;
  };
  /// The lit part of a flight in a shell.
  struct Crossing {
    const Shell* shell;
    Segment segment;
  };
  const Shell* shell_of(std::size_t light) const;
  Rgb sample(const Crossing& crossing, Rng& rng) const;

  const World& world_;
  std::vector<Shell> shells_;
  std::vector<int> shell_of_light_; ///< -1: it has none; empty where no light has one
};

} // namespace vdbeam
