#pragma once

#include "camera/camera.h"
#include "grids/emission_grid.h"
#include "lights/light_set.h"
#include "lights/sky/aerial_perspective.h"
#include "medium/emission_directions.h"
#include "medium/medium.h"
#include "transport/surfaces.h"
#include "vdb/vdb_reader.h"

#include <string>

namespace vdbeam {

/// A scene made ready for tracing: everything in render space. Immutable while rendering.
struct World {
  RenderSpace space;
  Medium medium;
  LightSet lights;
  OccupiedRegion region;                    ///< of the medium
  std::shared_ptr<const Surfaces> surfaces; ///< null: there are none
  /// Targets of photons, in a scene with surfaces or nests: the volumes of the smallest nest,
  /// spheres around nests, the medium, what is around it.
  std::vector<OccupiedRegion> targets;
  std::size_t medium_targets = 0; ///< the first of these: up to the medium
  std::size_t first_sphere = 0;   ///< of these, the first that surfaces and medium send copies to
  /// Towards what glows in the medium, where surfaces may see it; else null.
  std::shared_ptr<const EmissionDirections> emission;
  /// The air between the camera and what it sees first; null: none.
  std::shared_ptr<const AerialPerspective> air;
  std::size_t air_light = 0; ///< the light with whose group the air's light counts
};

/// Whether the camera sees all of what it sees of the medium by its rays, and nothing by way of
/// mirrors or glass.
inline bool sees_directly(const World& world) {
  return !world.surfaces || !world.surfaces->show_surroundings();
}

/// The group to which the light of a surface belongs; -1: there are none.
inline int group_of(const World& world, const SurfaceVertex& vertex) {
  return vertex.light() < 0 ? -1 : world.lights.group(static_cast<std::size_t>(vertex.light()));
}

/// No surface stands between a point and a light, or another point, at a distance along
/// `direction`. What lies within 1e-4 of the distance before its end does not count: it is the end.
inline bool unoccluded(const World& world, const Vec3d& origin, const Vec3f& direction,
                       float distance) {
  return !world.surfaces ||
         !world.surfaces->set->occluded(origin, Vec3d(direction), 0,
                                        static_cast<double>(distance) * (1 - 1e-4));
}

/// The part of a flight from `origin` on that lies in the medium, and in `end` the surface at which
/// the flight ends, if it does.
Segment flight_segment(const World& world, const Vec3d& origin, const Vec3f& direction,
                       std::optional<SurfaceHit>& end);

/// Facts about the volumes of a world, for the plan and for notes.
struct WorldFacts {
  struct Voxels {
    std::uint64_t density = 0;  ///< active voxels; 0: the volume is left out as empty
    std::uint64_t emission = 0; ///< active voxels of its emission grids; 0: it does not glow
  };
  /// Counts of what had to be made for the surfaces.
  struct SurfaceWork {
    int meshes_read = 0, textures_read = 0, trees_built = 0;
  };
  std::vector<Voxels> volumes; ///< one per scene.volumes entry
  SurfaceWork surfaces;
  std::vector<std::string> notes;
};

/// Builds the world from the volumes' fields: one grid per scene.volumes entry; of emission as
/// many, or none at all. Throws InputError for lights that cannot be made. `facts`, unless it is
/// null, is filled. Of the `previous` world meshes, textures and Embree's trees are taken as far as
/// they are the same.
World build_world(const Scene& scene, std::vector<DensityGrid> grids,
                  std::vector<EmissionGrid> emissions = {}, WorldFacts* facts = nullptr,
                  const World* previous = nullptr);

} // namespace vdbeam
