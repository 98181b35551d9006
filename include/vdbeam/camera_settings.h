#pragma once

#include "vdbeam/color_space.h"
#include "vdbeam/layer_settings.h"
#include "vdbeam/vec.h"

#include <optional>
#include <string>

namespace vdbeam {

/// Projection of a camera.
enum class Projection {
  perspective,
  orthographic, ///< parallel rays
  panorama      ///< lat-long, all around
};

/// Axis conversion from the world of a camera file to the scene's.
enum class FileAxes { same, y_up_to_z_up, z_up_to_y_up };

/// Order of the rotations of a camera file: zxy rotates about Z first, then X, then Y.
enum class RotationOrder { zxy, xyz, xzy, yxz, yzx, zyx };

/// Reconstruction filter: distribution of the rays of a pixel.
enum class PixelFilter { box, gaussian, blackman_harris };

struct ImageSettings {
  int width = 640;  ///< pixels
  int height = 360; ///< pixels
  std::optional<double> fps =
      std::nullopt;        ///< frames per second of the shot, for the image's attributes alone
  double pixel_aspect = 1; ///< a pixel's width over its height
  int overscan = 0;        ///< additional pixels beyond each edge of the image
  PixelFilter filter = PixelFilter::box;
  double filter_width = 0; ///< pixels; 0: automatic
  Compression compression = Compression::zip;
  ImageParts parts = ImageParts::one;
  int tile = 0; ///< width of the EXR's tiles [pixels]; 0: it has scan lines
  LayerNames layer_names = LayerNames::vdbeam;
  std::string time_code = {};                    ///< of frame 0, "hh:mm:ss:ff"; empty: all zero
  std::string attributes = {};                   ///< of the user's own, "name = text; name = text"
  ColorSpace working_space = ColorSpace::rec709; ///< linear RGB of the rendering
  std::string output_space = {}; ///< of the EXR; empty: the working space (docs/reference/scene.md)
  bool cryptomatte = false;      ///< ids of volumes and meshes
  bool deep = false;             ///< write a deep image beside the flat one
  double deep_alpha = 0.05;      ///< greatest opacity of a deep sample
  double deep_depth = 0;         ///< greatest length of a sample [world]; 0: automatic

  /// Size of the image with its overscan.
  int raster_width() const { return width + 2 * overscan; }
  int raster_height() const { return height + 2 * overscan; }
};

struct CameraSettings {
  Vec3d position{0, 0, 5};
  Vec3d look_at{0, 0, 0};
  Vec3d up{0, 1, 0}; ///< the way up of the world, about which skies turn
  double fov = 30;   ///< vertical, degrees
  Projection projection = Projection::perspective;
  std::optional<double> focal_length; ///< mm; instead of fov
  double film_width = 36;             ///< mm
  double view_height = 0;             ///< orthographic: height of the visible area [world]
  double shift_x = 0;                 ///< lens shift to the right, in image widths
  double shift_y = 0;                 ///< lens shift up, in image heights
  double near = 0;                    ///< near clipping depth [world]
  std::optional<double> far;          ///< far clipping depth [world]
  double lens_radius = 0;             ///< [world]; 0: pinhole
  std::optional<double> f_stop;       ///< instead of lens_radius, with focal_length
  double unit_in_mm = 1000;           ///< length of a world unit, for f_stop
  double focus_distance = 0;          ///< along the axis [world]; 0: that of look_at
  int blades = 0;                     ///< number of aperture blades; 0: round
  double blade_angle = 0;             ///< rotation of the aperture, counter-clockwise, degrees
  std::string file;                   ///< file with position, direction and roll; empty: none
  std::string name;                   ///< of the camera in a glTF file; empty: the first
  double file_fps = 24;               ///< frames per second of a glTF file
  FileAxes file_axes = FileAxes::same;
  RotationOrder file_rotation = RotationOrder::zxy;
  /// Up direction of the image from a camera file; otherwise `up`.
  std::optional<Vec3d> picture_up;
  double shutter_open = 0;  ///< when the shutter opens, from the frame on [frames]
  double shutter_close = 0; ///< when it closes
  int shutter_times = 0;    ///< number of motion samples; 0: automatic

  /// The shutter is open for some time.
  bool has_shutter() const { return shutter_close > shutter_open; }
  /// Radius of the lens [world].
  double aperture_radius() const {
    return f_stop && focal_length ? *focal_length / (2 * *f_stop * unit_in_mm) : lens_radius;
  }
};

} // namespace vdbeam
