#include "layers/scene_motion.h"

#include <cmath>

namespace vdbeam {
namespace {

const Scene& frame_later(const Scene& scene) {
  return scene.next.empty() ? scene : scene.next.front();
}

Affine way(const std::array<double, 12>& from, const std::array<double, 12>& to) {
  return Affine::from_matrix(to).after(Affine::from_matrix(from).inverse());
}

} // namespace

SceneMotion::SceneMotion(const Scene& scene, const Velocities& velocities)
    : now_(scene.camera, scene.image, {}), later_(frame_later(scene).camera, scene.image, {}),
      width_(scene.camera.projection == Projection::panorama ? scene.image.width : 0) {
  const Scene& later = frame_later(scene);
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const VolumeSettings& volume = scene.volumes[i];
    volumes_.push_back(way(volume.transform, later.volumes[i].transform));
    Flow& flow = flows_.emplace_back();
    if (i >= velocities.size() || !velocities[i] || velocities[i]->empty())
      continue;
    flow.velocity = velocities[i];
    const Affine placed = Affine::from_matrix(volume.transform);
    const Affine lattice = placed.after(flow.velocity->index_to_world());
    const VelocityScale meaning = scale_of(volume.velocity, flow.velocity->from_mantaflow());
    flow.to_index = lattice.inverse();
    flow.to_world = meaning.index ? lattice : placed;
    for (Vec3d& row : flow.to_world.rows)
      row *= meaning.factor;
    flow.seconds_per_frame = 1 / volume.velocity.fps;
  }
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
    meshes_.push_back(way(scene.surfaces[i].transform, later.surfaces[i].transform));
}

void SceneMotion::set_moment(const Scene& moment) {
  for (std::size_t i = 0; i < flows_.size() && i < moment.volumes.size(); ++i)
    flows_[i].moved = moment.volumes[i].velocity.time;
}

/// What moved to the point came from where its velocity is known: a fixed point, as in moved_grid.
Vec3d SceneMotion::Flow::at(const Vec3d& point) const {
  const auto velocity_at = [&](const Vec3d& p) {
    return to_world.vector(velocity->sample(to_index.point(p)));
  };
  Vec3d result = velocity_at(point);
  for (int step = 0; step < 3 && moved != 0; ++step)
    result = velocity_at(point - result * moved);
  return result;
}

SceneMotion::Pixels SceneMotion::projected(const Vec3d& from, const Vec3d& to) const {
  const auto a = now_.project(from), b = later_.project(to);
  if (!a || !b)
    return {};
  double x = (*b)[0] - (*a)[0];
  if (width_ > 0)
    x -= width_ * std::round(x / width_);
  return {x, (*a)[1] - (*b)[1]};
}

SceneMotion::Pixels SceneMotion::of_volume(std::size_t volume, const Vec3d& point) const {
  const Flow& flow = flows_[volume];
  const Vec3d moved = flow.velocity ? point + flow.at(point) * flow.seconds_per_frame : point;
  return projected(point, volumes_[volume].point(moved));
}

SceneMotion::Pixels SceneMotion::of_mesh(std::size_t mesh, const Vec3d& point) const {
  return projected(point, meshes_[mesh].point(point));
}

} // namespace vdbeam
