#include "keys/scene_key_builder.h"

namespace vdbeam {

void add_image_keys(KeyTable& table) {
  using I = ImageSettings;
  table.section(SceneSection::image);
  table.add("width", &ImageSettings::width, "width of the picture")
      .unit("pixels")
      .within(1, 65536)
      .always_written()
      .keeps_world();
  table.add("height", &ImageSettings::height, "height of the picture")
      .unit("pixels")
      .within(1, 65536)
      .always_written()
      .keeps_world();

  table
      .add("fps", &ImageSettings::fps,
           "frames per second, for the attributes framesPerSecond and timeCode of the image")
      .within(1, 1000)
      .absent("none")
      .keeps_picture()
      .keeps_world();
  table.add("compression", &I::compression, "compression of the EXR; dwaa and dwab are lossy")
      .keeps_picture()
      .keeps_world();
  table.add("parts", &I::parts, "whether the layers of the EXR share one part or have one each")
      .keeps_picture()
      .keeps_world();
  table.add_auto("tile", &I::tile, "width of the EXR's tiles; none: it has scan lines")
      .unit("pixels")
      .within(16, 4096)
      .absent("none")
      .keeps_picture()
      .keeps_world();
  table
      .add("layer_names", &I::layer_names,
           "whose names the EXR's layers have: vdbeam's own, Arnold's or Cycles'")
      .keeps_picture()
      .keeps_world();
  table
      .add("time_code", &I::time_code,
           R"(time code of frame 0, "hh:mm:ss:ff", from which frames are counted; "": all zero)")
      .keeps_picture()
      .keeps_world();
  table
      .add("attributes", &I::attributes,
           R"(further attributes of the EXR, "name = text; name = text"; "": none)")
      .keeps_picture()
      .keeps_world();
  table.add("working_space", &I::working_space,
            "linear RGB in which light is rendered; colours in scene files are of Rec.709");
  table
      .add(
          "output_space", &I::output_space,
          R"(colour space of the EXR: one that working_space may have, or one of the OpenColorIO configuration; "": as rendered)")
      .keeps_picture()
      .keeps_world();
  table
      .add("cryptomatte", &I::cryptomatte,
           "whether the image has Cryptomatte layers of volumes and meshes")
      .keeps_world();
  table.add("deep", &I::deep, "whether a deep EXR with the medium's samples is written too")
      .keeps_world();
  table.add("deep_alpha", &I::deep_alpha, "the most that a deep sample adds to the opacity")
      .within(0.001, 1)
      .keeps_world();
  table
      .add_auto("deep_depth", &I::deep_depth,
                "greatest length of a deep sample; auto: a 16th of the medium's size")
      .unit("world")
      .above(0)
      .keeps_world();
  table.add("pixel_aspect", &I::pixel_aspect, "width of a pixel over its height")
      .within(0.01, 100)
      .keeps_world();
  table.add("overscan", &I::overscan, "pixels that are rendered beyond each edge of the picture")
      .unit("pixels")
      .within(0, 16384)
      .keeps_world();
  table.add("filter", &I::filter, "how a pixel's rays are spread").keeps_world();
  table.add_auto("filter_width", &I::filter_width, "width of the filter; auto: 1 for a box, else 2")
      .unit("pixels")
      .above_up_to(0, 16)
      .keeps_world();
}

namespace {

void add_lens_keys(KeyTable& table) {
  using C = CameraSettings;
  table.add("focal_length", &C::focal_length, "instead of fov: focal length for film_width")
      .unit("mm")
      .above(0)
      .absent("none");
  table.add("film_width", &C::film_width, "width of the film that the picture fills")
      .unit("mm")
      .above(0);
  table.add("shift_x", &C::shift_x, "moves the picture on the film to the right, in its widths");
  table.add("shift_y", &C::shift_y, "moves the picture on the film up, in its heights");
  table.add("near", &C::near, "depth before which nothing is seen").unit("world").at_least(0);
  table.add("far", &C::far, "depth beyond which neither medium nor surface is seen")
      .unit("world")
      .above(0)
      .absent("none");
  table.add("lens_radius", &C::lens_radius, "radius of a thin lens; 0: everything is sharp")
      .unit("world")
      .at_least(0);
  table.add("f_stop", &C::f_stop, "instead of lens_radius: focal_length over the lens's diameter")
      .above(0)
      .absent("none");
  table.add("unit_in_mm", &C::unit_in_mm, "length of a world unit, for f_stop").unit("mm").above(0);
  table
      .add_auto("focus_distance", &C::focus_distance,
                "depth of the plane that is sharp; auto: that of look_at")
      .unit("world")
      .above(0);
  table.add("blades", &C::blades, "edges of the lens's aperture; 0: it is round").within(0, 64);
  table.add("blade_angle", &C::blade_angle, "turns the aperture counter-clockwise").unit("degrees");
}

} // namespace

void add_camera_keys(KeyTable& table) {
  using C = CameraSettings;
  table.section(SceneSection::camera);
  table.add("position", &CameraSettings::position, "where the camera stands")
      .unit("world")
      .always_written()
      .keeps_world();
  table.add("look_at", &CameraSettings::look_at, "the point in the middle of the picture")
      .unit("world")
      .always_written()
      .keeps_world();
  table.add("up", &CameraSettings::up, "the direction that is up in the picture").always_written();
  table.add("fov", &CameraSettings::fov, "vertical field of view")
      .unit("degrees")
      .inside(0, 180)
      .always_written()
      .keeps_world();
  table.add("projection", &C::projection,
            "perspective, parallel rays, or a lat-long picture of all directions");
  table.add_auto("view_height", &C::view_height, "orthographic: height of what the picture shows")
      .unit("world")
      .above(0)
      .absent("none");
  add_lens_keys(table);
  table
      .add("file", &C::file,
           "a .chan file, matrices or a glTF file with the camera, instead of position and look_at")
      .file(InputKind::camera);
  table.add(
      "name", &C::name,
      R"(glTF: name of the node that holds the camera (in Blender, the camera object); "": the first)");
  table.add("file_fps", &C::file_fps, "glTF: frames in a second, of which frame 0 is the first")
      .above(0);
  table.add("file_axes", &C::file_axes, "how the world of the file is turned into this one");
  table.add("file_rotation", &C::file_rotation, "which of a .chan file's angles turns first");
  table
      .add("shutter_open", &C::shutter_open, "when the shutter opens, relative to the frame's time")
      .unit("frames")
      .within(-1000, 1000);
  table.add("shutter_close", &C::shutter_close, "when it closes; no earlier than it opens")
      .unit("frames")
      .within(-1000, 1000);
  table
      .add_auto("shutter_times", &C::shutter_times,
                "moments in between at which volumes and lights are seen; auto: 16")
      .within(1, 1024);
}

} // namespace vdbeam
