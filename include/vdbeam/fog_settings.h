#pragma once

namespace vdbeam {

/// What a volume's density comes from: a VDB file; or a formula in the box from box_lower to
/// box_upper, of the volume's own space: 1 everywhere; 1 in the ellipsoid that touches the box's
/// faces; exp(-(y - box_lower.y) / scale_height).
enum class VolumeShape { file, box, sphere, height };

struct FogSettings {
  VolumeShape shape = VolumeShape::file;
  double scale_height = 1;      ///< height: over which the density falls to 1/e [own space]
  double least_density = 0.001; ///< height: where the density is less than this, there is none

  bool made() const { return shape != VolumeShape::file; } ///< without a file
};

} // namespace vdbeam
