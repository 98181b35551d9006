#pragma once

#include "vdbeam/vec.h"

#include <span>
#include <string>

namespace vdbeam {

/// How scene-linear radiance becomes what a monitor shows.
struct ViewTransform {
  const char* name;        ///< as --view calls it
  const char* description; ///< for --help
  /// Linear radiance (Rec.709 primaries, at least 0, any size) to linear display values in [0, 1].
  Vec3d (*apply)(const Vec3d& radiance);
};

/// Every view, the default first.
std::span<const ViewTransform> view_transforms();

/// The view of a name. Throws InputError, naming the known ones.
const ViewTransform& view_transform(const std::string& name);

} // namespace vdbeam
