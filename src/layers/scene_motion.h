#pragma once

#include "camera/camera.h"
#include "vdb/vector_reader.h"

#include <array>
#include <memory>
#include <vector>

namespace vdbeam {

using Velocities = std::vector<std::shared_ptr<const VectorField>>; ///< by volume; null: none

/// How far things move in the picture from the frame's time to a frame later: by the motion of the
/// camera, by the transforms of volumes and meshes, and by the velocities of volumes.
class SceneMotion {
public:
  /// Pixels to the right, and up.
  using Pixels = std::array<double, 2>;

  /// Motion from a scene to the same scene a frame later (Scene::next).
  SceneMotion(const Scene& scene, const Velocities& velocities);
  /// Where volumes were moved already, for a moment of the shutter's time.
  void set_moment(const Scene& moment);

  /// Motion in pixels of a point of a volume or mesh of the scene; 0 for points that are not in
  /// front of the camera, now or later.
  Pixels of_volume(std::size_t volume, const Vec3d& point) const;
  Pixels of_mesh(std::size_t mesh, const Vec3d& point) const;

private:
  /// Velocity of one volume, and the maps between the world and the lattice of the velocity.
  struct Flow {
    std::shared_ptr<const VectorField> velocity; ///< null: it has none
    Affine to_index, to_world;                   ///< the latter of vectors
    double seconds_per_frame = 0, moved = 0;     ///< the latter: time for which it was moved
    /// World, in a second.
    Vec3d at(const Vec3d& point) const;
  };
  Pixels projected(const Vec3d& from, const Vec3d& to) const;

  Camera now_, later_; ///< in the world, whose scale is 1
  double width_;       ///< of a panorama that closes on itself; 0: it does not [pixels]
  std::vector<Flow> flows_;
  std::vector<Affine> volumes_, meshes_; ///< from now to a frame later
};

} // namespace vdbeam
