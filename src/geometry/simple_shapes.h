#pragma once

#include "geometry/shape.h"

namespace vdbeam {

/// The plane z = 0 without an end, with its front towards +z. A picture on it repeats with every
/// unit. Rays within 1e-9 of parallel miss it, so distances stay numbers.
std::shared_ptr<const Shape> make_plane_shape();
/// The cube from -1 to 1. Each face shows the whole picture, upright with +z up.
std::shared_ptr<const Shape> make_box_shape();
/// Radius 1 about the z axis, from -1 to 1, closed by two disks. The picture goes round the side,
/// from +x towards +y, and is cut out of the square around each disk.
std::shared_ptr<const Shape> make_cylinder_shape();

} // namespace vdbeam
