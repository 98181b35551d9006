#include "scene/shutter.h"

#include "layers/plane_layers.h"

#include <algorithm>

namespace vdbeam {
namespace {

constexpr int usual_times = 16, cameras_per_time = 4;

bool may_have_velocity(const Scene& scene) {
  return std::any_of(scene.volumes.begin(), scene.volumes.end(), [](const VolumeSettings& volume) {
    return volume.present && volume.velocity.grid != "none" && volume.velocity.scale != 0;
  });
}

} // namespace

int shutter_times(const CameraSettings& camera) {
  return camera.shutter_times > 0 ? camera.shutter_times : usual_times;
}

void add_moments(Scene& scene, bool animated, const std::function<Scene(double time)>& scene_at) {
  scene.moments.clear();
  scene.next.clear();
  if (animated && asks_for_layer(scene, "motion"))
    scene.next.push_back(scene_at(scene.frame.time + 1));
  const CameraSettings& camera = scene.camera;
  if (!camera.has_shutter() || !(animated || may_have_velocity(scene)))
    return;
  const int times = shutter_times(camera);
  const double length = camera.shutter_close - camera.shutter_open;
  const auto time_of = [&](int part, int parts) {
    return scene.frame.time + camera.shutter_open + (part + 0.5) / parts * length;
  };
  const auto seen_at = [&](double time) {
    if (animated)
      return scene_at(time);
    Scene same = scene;
    same.moments.clear();
    return same;
  };
  std::vector<Scene> moments;
  for (int i = 0; i < times; ++i) {
    const double time = time_of(i, times);
    Scene moment = seen_at(time);
    moment.render = scene.render;
    moment.frame.time = time;
    for (VolumeSettings& volume : moment.volumes)
      volume.velocity.time = (time - scene.frame.number) / volume.velocity.fps;
    for (int c = 0; c < cameras_per_time; ++c) {
      moments.push_back(moment);
      if (!animated)
        continue;
      const Vec3d up = moment.camera.up; // about which skies turn
      CameraSettings& seen = moments.back().camera;
      seen = scene_at(time_of(i * cameras_per_time + c, times * cameras_per_time)).camera;
      if (!seen.picture_up)
        seen.picture_up = seen.up;
      seen.up = up;
    }
  }
  scene.moments = std::move(moments);
}

} // namespace vdbeam
