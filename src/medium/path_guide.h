#pragma once

#include "medium/medium.h"

#include <vector>

namespace vdbeam {

/// A lattice of equal blocks over the medium, no finer than the cells of its volumes, for tables of
/// bounded size.
class MediumBlocks {
public:
  explicit MediumBlocks(const Medium& medium);

  const Vec3<int>& counts() const { return counts_; }
  std::size_t size() const { return static_cast<std::size_t>(counts_.x) * counts_.y * counts_.z; }
  /// Offset of the block of a point, outside of the nearest one.
  std::size_t at(const Vec3f& point) const {
    const Vec3f block = (point - lower_) * per_unit_;
    const Vec3f inside = min(max(block, Vec3f(0)), Vec3f(counts_) - Vec3f(1));
    return (static_cast<std::size_t>(inside.x) * counts_.y + static_cast<std::size_t>(inside.y)) *
               counts_.z +
           static_cast<std::size_t>(inside.z);
  }
  /// The point at `within`, in [0, 1]^3, of the block (x, y, z).
  Vec3f point(const Vec3<int>& block, const Vec3f& within) const;

  /// Moves the lattice [render units].
  void move(const Vec3f& by) { lower_ += by; }
  /// The lattice in other units; `factor` of them are one present unit.
  void scale(float factor) {
    lower_ *= factor;
    per_unit_ *= 1 / factor;
  }

  bool operator==(const MediumBlocks&) const = default;

private:
  Vec3<int> counts_{1, 1, 1};
  Vec3f lower_, per_unit_; ///< blocks per render unit
};

/// Where light paths are worth their time: the importance of flux for the picture (the adjoint of
/// Wagner and Haghighat's CADIS, 1998), that is what a path of unit flux is expected to bring
/// there. Emission is drawn in proportion to it, and weight windows keep flux times importance of
/// paths under way near what a path brings on average (docs/theory/beam.md).
struct PathGuide {
  /// Steps of a light's emission, each with its own density.
  static constexpr int steps = 256;
  /// A place of emission (Light::emit) and its density relative to a uniform choice.
  struct Emission {
    double place = 0, density = 1;
  };

  explicit PathGuide(const MediumBlocks& lattice) : blocks(lattice) {}

  MediumBlocks blocks;
  std::vector<float> importance;                 ///< by block
  double total = 0;                              ///< that all light brings together
  std::vector<double> light_shares;              ///< of the paths, per light; their sum is 1
  std::vector<std::vector<double>> distribution; ///< per light: cumulative, steps + 1 values

  /// Expected contribution of a path of this flux, in its strongest channel, at a point, relative
  /// to the mean of `paths` paths.
  float relative_value(float flux, const Vec3f& point, std::uint64_t paths) const {
    return static_cast<float>(static_cast<double>(flux) *
                              static_cast<double>(importance[blocks.at(point)]) *
                              static_cast<double>(paths) / total);
  }
  /// The same where `factor` units of length are one of the present.
  PathGuide in_units(float factor) const;
  /// Where light l starts the path drawn by u in [0, 1).
  Emission emission(std::size_t l, double u) const;

  bool operator==(const PathGuide&) const = default;
};

} // namespace vdbeam
