#pragma once

#include "math/ray.h"
#include "volume/emission_field.h"

#include <array>
#include <memory>

namespace vdbeam {

/// A volume's own light in render space: j(x) = strength * field [radiance / render unit],
/// independent of what absorbs or scatters there.
struct Emitter {
  std::shared_ptr<const EmissionField> field;
  Affine to_render;          ///< local coordinates of the field -> render space
  std::array<Vec3f, 3> rows; ///< render space -> local coordinates
  Vec3f translation;
  Rgb strength{1, 1, 1};

  Vec3f local_point(const Vec3f& p) const { return local_vector(p) + translation; }
  Vec3f local_vector(const Vec3f& v) const {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
};

} // namespace vdbeam
