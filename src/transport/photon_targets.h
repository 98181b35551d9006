#pragma once

#include "lights/cone.h"
#include "transport/world.h"

#include <functional>
#include <limits>

namespace vdbeam {

/// Adds the surfaces to the targets of photons (AimedLight), after the medium: those within boxes
/// about it, each four times as wide as the one before, at last all of them. Only the latter where
/// there is no medium.
void add_surface_targets(const OccupiedRegion& medium, const SurfaceSet& surfaces,
                         std::vector<OccupiedRegion>& targets);

/// Whether a photon of a light counts: the first of the world's targets that its line meets is one
/// of its own.
bool counts_for_its_target(const World& world, const Light& light, const EmittedPhoton& photon);

/// Where the flight of a photon begins: at the edge of the region that it is aimed at, or, where
/// that lies in the medium or a surface stands before it, at its light, or before everything if the
/// light is far away.
Vec3d beginning_of_flight(const World& world, const Light& light, const EmittedPhoton& photon);

/// How wide the surfaces are, render units; a plane counts as ten times what stands on it.
double surface_extent(const World& world);

/// False for points of planes so far away that what photons bring there is not seen, while they
/// would spoil the scale of all others.
bool may_hold_photons(const World& world, const SurfaceHit& hit);

/// The cones about the spheres of the world's targets as seen from a point, from the first sphere
/// on up to that in which the point lies, which has none.
class TargetCones {
public:
  /// `end`: the first target that does not count.
  TargetCones(const World& world, const Vec3d& point,
              std::size_t end = std::numeric_limits<std::size_t>::max());

  std::size_t size() const { return cones_.size(); }
  const Cone& operator[](std::size_t i) const { return cones_[i]; }
  /// The target of a cone; of cone size(), that in whose sphere the point lies.
  std::size_t target(std::size_t i) const { return first_ + i; }
  /// Drops the cones from the first target on that `keep` does not accept.
  template <class Keep>
  void keep_while(const Keep& keep) {
    std::size_t kept = 0;
    while (kept < size() && keep(target(kept)))
      ++kept;
    cones_.resize(kept);
  }
  /// The first that holds a direction; size() where none does.
  std::size_t first_of(const Vec3f& direction) const;

private:
  std::size_t first_;
  std::vector<Cone> cones_;
};

/// Copies of a light path that a surface sends into a cone.
struct Copies {
  static constexpr int most = 8;

  int count = 0;
  float solid_angle = 0; ///< that each of them stands for
};

/// Number of copies such that each carries about the flux of photons that reach the target straight
/// from their light; `flux`: of the path, in units of that; `value` [1 / sr]: the part of it that
/// goes into a direction of the cone. Where that is less than one copy, there is one by chance,
/// which stands for the others.
Copies copies_into(const Cone& cone, float value, float flux, Rng& rng);

/// Adds the scene's lights, aimed at each of the world's targets. Throws as LightSet does.
void add_aimed_lights(const std::vector<LightSettings>& settings, const Vec3d& up,
                      std::vector<std::string>& notes, World& world);

/// The light of a surface that shines, aimed at the medium, its nests and the rest; `make(medium)`
/// makes it, aimed at a region or, where that is null, at all that it shines on.
std::unique_ptr<Light>
aim_surface_light(const World& world,
                  const std::function<std::unique_ptr<Light>(const OccupiedRegion*)>& make);

} // namespace vdbeam
