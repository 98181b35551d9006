#pragma once

#include "walks/lamp_shells.h"

#include <optional>
#include <vector>

namespace vdbeam {

/// Directions of flights that pass close to lamps in the medium. Such a flight finds about 1 / D of
/// a lamp's light, D being its distance from the lamp (LampShells), whatever the phase function:
/// walks that draw their directions by phase functions alone have rare, very bright values. The
/// angle to the lamp has the density g of scattering angles (ScatteringAngles), whose even part is
/// proportional to 1 / D per solid angle (docs/theory/transport.md, T.17).
class LampDirections {
public:
  /// Takes the lamps that have shells. `world` must outlive this.
  LampDirections(const World& world, const LampShells& shells);

  bool any() const { return !lamps_.empty(); }
  /// A direction about one of the lamps in reach of the point, with a chance that goes with its
  /// share of the power of all lights: a faint lamp takes nothing from them.
  std::optional<Vec3f> sample(const Vec3f& point, Rng& rng) const;
  /// The chance that `sample` returns a direction.
  float chance(const Vec3f& point) const;
  /// The chance times the density of the directions [1/sr].
  float density(const Vec3f& point, const Vec3f& direction) const;

  /// Distance up to which walks look for a lamp [render units]; 0 where it has no shell.
  static double reach(const LampShells& shells, std::size_t light);
  /// A direction about the unit vector `to_lamp`, and the density of such directions [1/sr].
  static Vec3f sample_about(const Medium& medium, const Vec3f& to_lamp, float u, float v);
  static float density_about(const Medium& medium, const Vec3f& to_lamp, const Vec3f& direction);

private:
  struct Lamp {
    Vec3d position;
    double reach;
    float chance;
    double intensity;

    bool reaches(const Vec3f& point) const { return length(position - Vec3d(point)) < reach; }
    Vec3f from(const Vec3f& point) const { return Vec3f(normalize(position - Vec3d(point))); }
  };
  /// Calls visit(lamp) for the lamps in reach of the point, the brightest there of many.
  template <class Visit>
  void for_each_in_reach(const Vec3f& point, const Visit& visit) const;

  const Medium& medium_;
  std::vector<Lamp> lamps_;
};

} // namespace vdbeam
