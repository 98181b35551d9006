#pragma once

#include "medium/medium.h"

#include <vector>

namespace vdbeam {

/// Lattices of equal blocks over the medium and over each of its nests, no finer than the cells of
/// their volumes, for tables of bounded size. A point belongs to the smallest one around it.
class MediumBlocks {
public:
  explicit MediumBlocks(const Medium& medium);

  /// Number of lattices: those of nests, smallest first, and last that of the medium.
  std::size_t lattices() const { return lattices_.size(); }
  const Vec3<int>& counts(std::size_t lattice) const { return lattices_[lattice].counts; }
  /// Offset of a lattice's first block; its further ones follow, z fastest.
  std::size_t first(std::size_t lattice) const { return lattices_[lattice].first; }
  /// Blocks of all lattices.
  std::size_t size() const { return lattices_.back().first + lattices_.back().size(); }
  /// Offset of the block of a point, outside of the nearest one.
  std::size_t at(const Vec3f& point) const {
    for (std::size_t i = 0; i + 1 < lattices_.size(); ++i)
      if (lattices_[i].holds(point))
        return lattices_[i].at(point);
    return lattices_.back().at(point);
  }
  /// The point at `within`, in [0, 1]^3, of the block (x, y, z) of a lattice.
  Vec3f point(std::size_t lattice, const Vec3<int>& block, const Vec3f& within) const;

  /// Moves the lattices [render units].
  void move(const Vec3f& by);
  /// The lattices in other units; `factor` of them are one present unit.
  void scale(float factor);

  bool operator==(const MediumBlocks&) const = default;

private:
  struct Lattice {
    Vec3<int> counts{1, 1, 1};
    Vec3f lower, per_unit; ///< blocks per render unit
    std::size_t first = 0;

    Lattice(const Boxf& box, float finest, std::size_t first_block);
    std::size_t size() const { return static_cast<std::size_t>(counts.x) * counts.y * counts.z; }
    bool holds(const Vec3f& point) const {
      const Vec3f block = (point - lower) * per_unit;
      return max_component(-block) <= 0 && max_component(block - Vec3f(counts)) < 0;
    }
    std::size_t at(const Vec3f& point) const {
      const Vec3f block = (point - lower) * per_unit;
      const Vec3f inside = min(max(block, Vec3f(0)), Vec3f(counts) - Vec3f(1));
      return first +
             (static_cast<std::size_t>(inside.x) * counts.y + static_cast<std::size_t>(inside.y)) *
                 counts.z +
             static_cast<std::size_t>(inside.z);
    }
    bool operator==(const Lattice&) const = default;
  };

  std::vector<Lattice> lattices_;
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
