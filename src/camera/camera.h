#pragma once

#include "camera/lens.h"
#include "camera/pixel_filter.h"
#include "math/affine.h"
#include "math/rng.h"
#include "vdbeam/scene.h"
#include "volume/render_space.h"

#include <array>
#include <optional>

namespace vdbeam {

/// Unit vectors of a camera: right, up and forward in the picture.
struct CameraFrame {
  Vec3d right, up, forward;
};
CameraFrame camera_frame(const CameraSettings& settings);

/// The picture without overscan at depth 1 before a perspective camera, in units of that depth; for
/// parallel rays at any depth, in world units. x to the right, y up.
struct ViewWindow {
  double x0 = -1, x1 = 1, y0 = -1, y1 = 1;

  bool operator==(const ViewWindow&) const = default;
};
ViewWindow view_window(const CameraSettings& settings, const ImageSettings& image);

/// A ray as it leaves the camera, in render space.
struct EyeRay {
  Vec3d origin, direction; ///< the direction has unit length
};

/// A camera in render space. Pixel (0, 0) is top left, of the overscan where there is one; pixel
/// coordinates are continuous, the centre of the first pixel being (0.5, 0.5).
class Camera {
public:
  Camera(const CameraSettings& settings, const ImageSettings& image, const RenderSpace& space);

  /// The ray through a pixel position and the middle of the lens.
  EyeRay ray(double px, double py) const;
  /// Depth along the camera's axis over distance, for the ray through a pixel position; 1 for a
  /// panorama.
  double depth_over_distance(double px, double py) const {
    return along_axis(ray(px, py).direction);
  }
  /// A random ray of the pixel (x, y), by its filter and through the lens. `shift`: is added to the
  /// numbers that are drawn for the position, and for the lens, modulo 1.
  EyeRay sample(int x, int y, Rng& rng, const std::array<double, 2>& shift = {0, 0}) const;
  /// How far apart the rays through the pixel position and through its neighbour to the right are
  /// at the distance t [render units].
  double pixel_width(double px, double py, double t) const;
  /// Where a point is in the picture, as a pixel position; nothing for one that is not before the
  /// camera.
  std::optional<std::array<double, 2>> project(const Vec3d& point) const;
  /// Unit direction of the ray of the picture that comes nearest to a point.
  Vec3d direction_towards(const Vec3d& point) const;
  /// False only where no ray of the picture can meet the box: it lies beyond one of the planes
  /// around the view.
  bool may_see(const Boxd& box) const;
  /// Distances along a ray between which the medium is seen.
  double nearest(const Vec3d& direction) const { return near_ / along_axis(direction); }
  double farthest(const Vec3d& direction) const { return far_ / along_axis(direction); }
  bool clips() const { return near_ > 0 || far_ < unlimited; }
  /// Whether rays of one picture start at different points.
  bool has_own_origins() const {
    return projection_ == Projection::orthographic || lens_.radius() > 0;
  }
  const Vec3d& origin() const { return origin_; }
  bool operator==(const Camera&) const = default;

  int width() const { return width_; }
  int height() const { return height_; }

private:
  static constexpr double unlimited = 1e30;

  double along_axis(const Vec3d& direction) const;
  Vec3d panorama_direction(double px, double py) const;
  /// Position in the image, in units of the window.
  double window_x(double px) const;
  double window_y(double py) const;

  Projection projection_;
  Vec3d origin_, forward_, right_, up_;
  double tan_half_ = 1, pixel_aspect_, center_x_ = 0, center_y_ = 0; ///< of the window, per depth
  double overscan_;
  ViewWindow raster_; ///< with the overscan and what filters reach beyond it
  double near_, far_;
  Lens lens_;
  double focus_;
  FilterSampler filter_;
  int width_, height_;                 ///< with the overscan
  int picture_width_, picture_height_; ///< without
};

} // namespace vdbeam
