#pragma once

#include "transport/world.h"

namespace vdbeam {

/// A box in local coordinates, in render space.
Parallelepiped parallelepiped(const Affine& local_to_render, const Boxd& local);

/// Adds the box and the cells of a field that are not empty.
void add_region(OccupiedRegion& region, const DensityField& field, const Affine& local_to_render);

/// Chooses the targets of photons where the world needs any, that is with surfaces or nests: what
/// is in the smallest nest, the spheres around the nests, the medium and the surfaces.
void choose_targets(World& world);

} // namespace vdbeam
