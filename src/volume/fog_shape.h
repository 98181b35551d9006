#pragma once

#include "math/affine.h"
#include "vdbeam/scene.h"

#include <array>

namespace vdbeam {

/// The box of a volume without a file, in its own space.
Boxd box_of(const VolumeSettings& volume);

/// The density of a volume without a file, as a formula, and the lattice on which it is stored. All
/// points are in the volume's own space, before its transform.
///
/// A box without noise is stored as it is. The density of a height fog without noise is stored by
/// the values at the lattice's planes, with a factor that makes the integral between two planes
/// exact. Everything else is stored with faces that rise over one voxel.
class FogShape {
public:
  explicit FogShape(const VolumeSettings& volume);

  /// Cells of 8^3 voxels along each axis; the first voxel is at the lattice's lower corner.
  const Vec3<int>& cells() const { return cells_; }
  /// Map from the lattice's index coordinates.
  const Affine& to_own() const { return to_own_; }
  /// It is the same along x and z, so that one brick serves for all cells of a height.
  bool is_layered() const { return settings_.shape == VolumeShape::height && !noisy_; }
  /// The noise's finest features would need a finer lattice than there may be.
  bool is_coarse() const { return coarse_; }

  /// What a cell holds.
  enum class Cell { empty, full, mixed };
  Cell cell(const Vec3<int>& cell) const;
  /// The stored value at a lattice point.
  double value(const Vec3d& index) const;
  /// Integral of the density without noise [own volume].
  double integral() const;

private:
  /// Cells that span the box along each axis: `most` along the longest.
  Vec3<int> evenly(int most) const;
  void place_box();
  void place_layers();
  void place_sphere();
  void place_noisy();
  void place(const Boxd& box);
  double density(const Vec3d& own) const;
  double in_sphere(const Vec3d& own) const;
  double in_box(const Vec3d& own) const;

  FogSettings settings_;
  NoiseSettings noise_;
  bool noisy_, coarse_ = false;
  Boxd box_; ///< of a height fog up to where it ends
  Vec3<int> cells_;
  Vec3d voxel_; ///< its edges
  Affine to_own_;
};

} // namespace vdbeam
