#pragma once

#include "volume/density_field.h"
#include "volume/field_limits.h"

#include <functional>
#include <string>

namespace vdbeam {

/// Builds a field, on the lattice of another, from its values at lattice points.
class FieldBuilder {
public:
  /// All that is marked lies within `bounds`. All coordinates are local ones of the field `like`.
  /// Throws FrameError, opening with `label`, for bounds that no table can hold.
  FieldBuilder(const DensityField& like, const Boxd& bounds, std::string label);

  /// Lattice points in the box may have values other than 0.
  void mark(const Boxd& box);
  /// Throws FrameError where the bricks would take more than the limit, and Stopped.
  DensityField build(const std::function<float(const Vec3d& local)>& value,
                     const FieldLimits& limits);

private:
  std::size_t offset(const Vec3<std::int64_t>& cell) const;

  std::string label_;
  Vec3<std::int64_t> origin_;        ///< of `like`
  Vec3<std::int64_t> lower_, upper_; ///< cells, upper excluded
  std::vector<std::int32_t> table_;
};

/// Calls visit(box) with the box of each cell that is not empty, and the voxel before it, which
/// ramps up to it.
void for_each_occupied_cell(const DensityField& field,
                            const std::function<void(const Boxd& box)>& visit);

} // namespace vdbeam
