#pragma once

#include "lights/occupied_region.h"
#include "transport/surface_store.h"
#include "transport/surfaces.h"
#include "vdbeam/surface_settings.h"
#include "volume/render_space.h"

#include <string>
#include <vector>

namespace vdbeam {

/// A shape in the world.
struct WorldShape {
  std::shared_ptr<const Shape> shape;
  Affine to_world;
};

/// The shapes of all surfaces; those of the same file, or of the same kind, share one. Throws
/// InputError and FrameError for meshes that cannot be read or lack texture coordinates.
std::vector<WorldShape> read_shapes(const std::vector<SurfaceSettings>& settings,
                                    SurfaceStore& store, std::vector<std::string>& notes);

/// Returns the bounds of all shapes but planes.
Boxd world_bounds(const std::vector<WorldShape>& shapes);

/// The surfaces in render space; null where there are none, and then nothing of Embree is started.
/// `store` has the shapes, and reads the textures: throws InputError, and reports problems
/// in the notes. Trees over shapes that are in the `previous` set are taken from there; it may
/// be null.
std::shared_ptr<const Surfaces>
build_surfaces(const std::vector<SurfaceSettings>& settings, const std::vector<WorldShape>& shapes,
               const RenderSpace& space, const OccupiedRegion& medium,
               const std::shared_ptr<SurfaceStore>& store, const SurfaceSet* previous,
               std::vector<std::string>& notes);

} // namespace vdbeam
