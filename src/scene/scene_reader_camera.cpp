#include "geometry/gltf/gltf_camera.h"
#include "scene/camera_file.h"
#include "scene/scene_reader.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

namespace vdbeam {

/// Takes the camera's place and direction, and its field of view where the scene gives none, from
/// its file.
void SceneReader::place_camera(const toml::table& table) {
  CameraSettings& camera = scene_.camera;
  if (camera.file.empty())
    return;
  for (const char* name : {"position", "look_at"})
    if (table.contains(name))
      throw InputError(fmt::format("{}: camera.{} excludes camera.file, which places the camera",
                                   locate(fmt::format("camera.{}", name)), name));
  if (!camera.name.empty() && !is_gltf_file(camera.file))
    throw InputError(locate("camera.name") + ": camera.name is for cameras of glTF files");
  const CameraPose pose = camera_file_.pose_at(camera, frame_.time);
  camera.position = pose.position;
  camera.look_at = pose.position + pose.forward;
  camera.picture_up = pose.up;
  if (pose.fov && !table.contains("fov"))
    camera.fov = *pose.fov;
  if (pose.first < pose.last && (frame_.time < pose.first || frame_.time > pose.last))
    scene_.notes.push_back(
        fmt::format("{}: has the camera from frame {:g} to {:g}; in frame {:g} it "
                    "stands still, as in the nearest of them",
                    camera.file, pose.first, pose.last, frame_.time));
}

} // namespace vdbeam
