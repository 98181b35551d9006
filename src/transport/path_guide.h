#pragma once

#include "transport/medium.h"

#include <vector>

namespace vdbeam {

/// Blocks of cells of a volume's grid: single cells of small grids, more of large ones, so that a
/// table over them stays small.
class CellBlocks {
public:
  explicit CellBlocks(const Volume& volume);

  const Vec3<int>& counts() const { return counts_; }
  std::size_t size() const { return static_cast<std::size_t>(counts_.x) * counts_.y * counts_.z; }
  /// Cells along an edge of a block.
  int width() const { return width_; }
  /// Offset of the block of a point, outside of the nearest one.
  std::size_t at(const Volume& volume, const Vec3f& point) const {
    const Vec3f block = volume.local_point(point) * per_local_;
    const Vec3f inside = min(max(block, Vec3f(0)), Vec3f(counts_) - Vec3f(1));
    return (static_cast<std::size_t>(inside.x) * counts_.y + static_cast<std::size_t>(inside.y)) *
               counts_.z +
           static_cast<std::size_t>(inside.z);
  }

  bool operator==(const CellBlocks&) const = default;

private:
  int width_ = 1;
  Vec3<int> counts_;
  float per_local_; ///< blocks per local unit
};

/// Where light paths are worth their time: the importance of flux for the picture (the adjoint of
/// Wagner and Haghighat's CADIS, 1998), that is what a path of unit flux is expected to bring
/// there. Emission is drawn in proportion to it, and weight windows keep flux times importance of
/// paths under way near what a path brings on average (docs/physics.md).
struct PathGuide {
  /// Steps of a light's emission, each with its own density.
  static constexpr int steps = 256;
  /// A place of emission (Light::emit) and its density relative to a uniform choice.
  struct Emission {
    double place = 0, density = 1;
  };

  struct Importance {
    CellBlocks blocks;
    std::vector<float> values;
    bool operator==(const Importance&) const = default;
  };

  std::vector<Importance> importance;            ///< per volume
  double total = 0;                              ///< that all light brings together
  std::vector<double> light_shares;              ///< of the paths, per light; their sum is 1
  std::vector<std::vector<double>> distribution; ///< per light: cumulative, steps + 1 values

  /// What a path of this flux at a point of volume v is expected to bring, relative to the mean of
  /// `paths` paths.
  float relative_value(float flux, const Volume& volume, std::size_t v, const Vec3f& point,
                       std::uint64_t paths) const {
    const Importance& table = importance[v];
    return static_cast<float>(static_cast<double>(flux) *
                              static_cast<double>(table.values[table.blocks.at(volume, point)]) *
                              static_cast<double>(paths) / total);
  }
  /// Where light l starts the path drawn by u in [0, 1).
  Emission emission(std::size_t l, double u) const;

  bool operator==(const PathGuide&) const = default;
};

} // namespace vdbeam
