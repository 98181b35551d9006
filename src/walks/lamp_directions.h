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
  class Vertex;
  /// The lamps in reach of this point, the brightest there of many.
  Vertex at(const Vec3f& point) const;

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

  const Medium& medium_;
  std::vector<Lamp> lamps_;
};

/// A vertex of a walk, and the lamps by which flights from there may pass.
class LampDirections::Vertex {
public:
  Vertex(const LampDirections& directions, const Vec3f& point);

  /// A direction about one of the lamps, with a chance that goes with its share of the power of all
  /// lights: a faint lamp takes nothing from them.
  std::optional<Vec3f> sample(Rng& rng) const;
  /// The chance that `sample` returns a direction.
  float chance() const;
  /// The chance times the density of the directions [1/sr].
  float density(const Vec3f& direction) const;

private:
  const Medium& medium_;
  Vec3f point_;
  std::vector<const Lamp*> lamps_;
};

inline LampDirections::Vertex LampDirections::at(const Vec3f& point) const {
  return {*this, point};
}

} // namespace vdbeam
