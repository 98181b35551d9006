#include "keys/scene_key_builder.h"

namespace vdbeam {

void add_image_keys(KeyTable& table) {
  using I = ImageSettings;
  table.section(SceneSection::image);
  table.add("width", &ImageSettings::width, "width of the image")
      .unit("pixels")
      .within(1, 65536)
      .always_written()
      .keeps_world();
  table.add("height", &ImageSettings::height, "height of the image")
      .unit("pixels")
      .within(1, 65536)
      .always_written()
      .keeps_world();

  table
      .add("fps", &ImageSettings::fps,
           "frames per second, for the image attributes framesPerSecond and timeCode")
      .within(1, 1000)
      .absent("none")
      .keeps_picture()
      .keeps_world();
  table.add("compression", &I::compression, "compression of the EXR; dwaa and dwab are lossy")
      .keeps_picture()
      .keeps_world();
  table.add("parts", &I::parts, "parts of the EXR, one for all layers or one for each layer")
      .keeps_picture()
      .keeps_world();
  table.add_auto("tile", &I::tile, "tile width of the EXR; none: scan lines")
      .unit("pixels")
      .within(16, 4096)
      .absent("none")
      .keeps_picture()
      .keeps_world();
  table.add("layer_names", &I::layer_names, "naming convention of the EXR's layers")
      .keeps_picture()
      .keeps_world();
  table
      .add("time_code", &I::time_code,
           R"(time code of frame 0, "hh:mm:ss:ff", from which frames are counted; "": all zero)")
      .keeps_picture()
      .keeps_world();
  table
      .add("attributes", &I::attributes,
           R"(additional EXR attributes, "name = text; name = text"; "": none)")
      .keeps_picture()
      .keeps_world();
  table.add("working_space", &I::working_space,
            "linear RGB space of the rendering; colours in scene files are Rec.709");
  table
      .add(
          "output_space", &I::output_space,
          R"(colour space of the EXR: a value of working_space, or a space of the OpenColorIO configuration; "": as rendered)")
      .keeps_picture()
      .keeps_world();
  table.add("cryptomatte", &I::cryptomatte, "write Cryptomatte layers of volumes and meshes")
      .keeps_world();
  table.add("deep", &I::deep, "also write a deep EXR with volume samples").keeps_world();
  table.add("deep_alpha", &I::deep_alpha, "greatest opacity of a deep sample")
      .within(0.001, 1)
      .keeps_world();
  table
      .add_auto("deep_depth", &I::deep_depth,
                "greatest length of a deep sample; auto: 1/16 of the medium's size")
      .unit("world")
      .above(0)
      .keeps_world();
  table.add("pixel_aspect", &I::pixel_aspect, "width of a pixel divided by its height")
      .within(0.01, 100)
      .keeps_world();
  table.add("overscan", &I::overscan, "additional pixels rendered beyond each edge of the image")
      .unit("pixels")
      .within(0, 16384)
      .keeps_world();
  table.add("filter", &I::filter, "reconstruction filter, the distribution of a pixel's rays")
      .keeps_world();
  table.add_auto("filter_width", &I::filter_width, "filter width; auto: 1 for a box, else 2")
      .unit("pixels")
      .above_up_to(0, 16)
      .keeps_world();
}

namespace {

void add_lens_keys(KeyTable& table) {
  using C = CameraSettings;
  table.add("focal_length", &C::focal_length, "focal length, instead of fov")
      .unit("mm")
      .above(0)
      .absent("none");
  table.add("film_width", &C::film_width, "width of the film back").unit("mm").above(0);
  table.add("shift_x", &C::shift_x, "lens shift to the right, in image widths");
  table.add("shift_y", &C::shift_y, "lens shift up, in image heights");
  table.add("near", &C::near, "near clipping depth").unit("world").at_least(0);
  table.add("far", &C::far, "far clipping depth for medium and surfaces")
      .unit("world")
      .above(0)
      .absent("none");
  table.add("lens_radius", &C::lens_radius, "radius of a thin lens; 0: pinhole")
      .unit("world")
      .at_least(0);
  table
      .add("f_stop", &C::f_stop,
           "f-number (focal length over lens diameter), instead of lens_radius")
      .above(0)
      .absent("none");
  table.add("unit_in_mm", &C::unit_in_mm, "length of a world unit, for f_stop").unit("mm").above(0);
  table
      .add_auto("focus_distance", &C::focus_distance,
                "depth of the focus plane; auto: that of look_at")
      .unit("world")
      .above(0);
  table.add("blades", &C::blades, "number of aperture blades; 0: round").within(0, 64);
  table.add("blade_angle", &C::blade_angle, "rotation of the aperture, counter-clockwise")
      .unit("degrees");
}

} // namespace

void add_camera_keys(KeyTable& table) {
  using C = CameraSettings;
  table.section(SceneSection::camera);
  table.add("position", &CameraSettings::position, "position of the camera")
      .unit("world")
      .always_written()
      .keeps_world();
  table.add("look_at", &CameraSettings::look_at, "point at the centre of the image")
      .unit("world")
      .always_written()
      .keeps_world();
  table.add("up", &CameraSettings::up, "up direction of the image").always_written();
  table.add("fov", &CameraSettings::fov, "vertical field of view")
      .unit("degrees")
      .inside(0, 180)
      .always_written()
      .keeps_world();
  table.add("projection", &C::projection,
            "perspective, parallel rays, or a lat-long image of all directions");
  table.add_auto("view_height", &C::view_height, "orthographic: height of the visible area")
      .unit("world")
      .above(0)
      .absent("none");
  add_lens_keys(table);
  table
      .add("file", &C::file,
           "camera file (.chan, matrices or glTF), instead of position and look_at")
      .file(InputKind::camera);
  table.add("name", &C::name,
            R"(glTF: name of the camera's node (in Blender, the camera object); "": the first)");
  table.add("file_fps", &C::file_fps, "glTF: frames per second; time 0 is frame 0").above(0);
  table.add("file_axes", &C::file_axes, "axis conversion from the file's world to the scene's");
  table.add("file_rotation", &C::file_rotation, "order of rotations in a .chan file");
  table
      .add("shutter_open", &C::shutter_open,
           "time at which the shutter opens, relative to the frame")
      .unit("frames")
      .within(-1000, 1000);
  table.add("shutter_close", &C::shutter_close, "time at which it closes; not before it opens")
      .unit("frames")
      .within(-1000, 1000);
  table
      .add_auto("shutter_times", &C::shutter_times,
                "number of motion samples of volumes and lights; auto: 16")
      .within(1, 1024);
}

} // namespace vdbeam
