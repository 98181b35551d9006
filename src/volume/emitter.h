#pragma once

#include "math/affine.h"
#include "math/ray.h"
#include "volume/emission_field.h"

#include <memory>

namespace vdbeam {

/// A volume's own light in render space: j(x) = strength * field [radiance / render unit],
/// independent of what absorbs or scatters there.
struct Emitter {
  std::shared_ptr<const EmissionField> field;
  Affine to_render; ///< local coordinates of the field -> render space
  Affinef to_local; ///< render space -> local coordinates
  Rgb strength{1, 1, 1};
  std::size_t setting = 0; ///< which volume of the scene it is

  Vec3f local_point(const Vec3f& p) const { return to_local.point(p); }
  Vec3f local_vector(const Vec3f& v) const { return to_local.vector(v); }
};

} // namespace vdbeam
