#include "camera/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

/// Tangent of half the vertical field of view.
double tan_half_height(const CameraSettings& settings, const ImageSettings& image) {
  if (!settings.focal_length)
    return std::tan(settings.fov * std::numbers::pi / 360);
  const double aspect = image.width * image.pixel_aspect / image.height;
  return settings.film_width / (2 * *settings.focal_length) / aspect;
}

} // namespace

CameraFrame camera_frame(const CameraSettings& settings) {
  CameraFrame frame;
  frame.forward = normalize(settings.look_at - settings.position);
  frame.right = normalize(cross(frame.forward, settings.picture_up.value_or(settings.up)));
  frame.up = cross(frame.right, frame.forward);
  return frame;
}

ViewWindow view_window(const CameraSettings& settings, const ImageSettings& image) {
  const bool parallel = settings.projection == Projection::orthographic;
  const double y = parallel ? settings.view_height / 2 : tan_half_height(settings, image);
  const double x = y * image.width * image.pixel_aspect / image.height;
  const double right = 2 * settings.shift_x * x, up = 2 * settings.shift_y * y;
  return {right - x, right + x, up - y, up + y};
}

Camera::Camera(const CameraSettings& settings, const ImageSettings& image, const RenderSpace& space)
    : projection_(settings.projection), origin_(space.point(settings.position)),
      pixel_aspect_(image.pixel_aspect), overscan_(image.overscan),
      near_(settings.near * space.scale),
      far_(settings.far ? *settings.far * space.scale : unlimited),
      filter_(image.filter, image.filter_width), width_(image.raster_width()),
      height_(image.raster_height()), picture_width_(image.width), picture_height_(image.height) {
  const CameraFrame frame = camera_frame(settings);
  forward_ = frame.forward;
  right_ = frame.right;
  up_ = frame.up;
  const bool parallel = projection_ == Projection::orthographic;
  tan_half_ = parallel ? settings.view_height / 2 * space.scale : tan_half_height(settings, image);
  center_x_ = 2 * settings.shift_x * tan_half_ * image.width * image.pixel_aspect / image.height;
  center_y_ = 2 * settings.shift_y * tan_half_;
  const double beyond = filter_.reach(); // a wide filter looks beyond the picture
  raster_ = {window_x(-beyond), window_x(width_ + beyond), window_y(height_ + beyond),
             window_y(-beyond)};
  if (projection_ == Projection::perspective)
    lens_ = Lens(settings.aperture_radius() * space.scale, settings.blades, settings.blade_angle);
  const double focus = settings.focus_distance > 0 ? settings.focus_distance
                                                   : length(settings.look_at - settings.position);
  focus_ = focus * space.scale;
}

double Camera::window_x(double px) const {
  return (2 * (px - overscan_) - picture_width_) / picture_height_ * tan_half_ * pixel_aspect_ +
         center_x_;
}

double Camera::window_y(double py) const {
  return (1 - 2 * (py - overscan_) / picture_height_) * tan_half_ + center_y_;
}

Vec3d Camera::panorama_direction(double px, double py) const {
  const double turn = ((px - overscan_) / picture_width_ - 0.5) * 2 * std::numbers::pi;
  const double elevation = (0.5 - (py - overscan_) / picture_height_) * std::numbers::pi;
  return normalize((forward_ * std::cos(turn) + right_ * std::sin(turn)) * std::cos(elevation) +
                   up_ * std::sin(elevation));
}

EyeRay Camera::ray(double px, double py) const {
  if (projection_ == Projection::panorama)
    return {origin_, panorama_direction(px, py)};
  const double x = window_x(px), y = window_y(py);
  if (projection_ == Projection::orthographic)
    return {origin_ + right_ * x + up_ * y, forward_};
  return {origin_, normalize(forward_ + right_ * x + up_ * y)};
}

EyeRay Camera::sample(int x, int y, Rng& rng, const std::array<double, 2>& shift) const {
  const auto draw = [&](std::size_t axis) {
    const double u = static_cast<double>(rng.uniform()) + shift[axis];
    return u < 1 ? u : u - 1;
  };
  const double px = x + filter_.offset(draw(0));
  const double py = y + filter_.offset(draw(1));
  if (!(lens_.radius() > 0))
    return ray(px, py);
  const double u = draw(0), v = draw(1);
  const Vec3d on_lens = lens_.sample(u, v);
  const Vec3d start = right_ * on_lens.x + up_ * on_lens.y;
  // All rays of a picture position meet in the plane of focus.
  const Vec3d meeting = (forward_ + right_ * window_x(px) + up_ * window_y(py)) * focus_;
  return {origin_ + start, normalize(meeting - start)};
}

double Camera::pixel_width(double px, double py, double t) const {
  const EyeRay here = ray(px, py), beside = ray(px + 1, py);
  return length(here.origin + here.direction * t - beside.origin - beside.direction * t);
}

std::optional<std::array<double, 2>> Camera::project(const Vec3d& point) const {
  const Vec3d p = point - origin_;
  const double x = dot(p, right_), y = dot(p, up_), z = dot(p, forward_);
  if (projection_ == Projection::panorama) {
    const double turn = std::atan2(x, z), elevation = std::atan2(y, std::hypot(x, z));
    return {{(turn / (2 * std::numbers::pi) + 0.5) * picture_width_ + overscan_,
             (0.5 - elevation / std::numbers::pi) * picture_height_ + overscan_}};
  }
  const bool parallel = projection_ == Projection::orthographic;
  if (!parallel && !(z > 0))
    return std::nullopt;
  const double depth = parallel ? 1 : z;
  // The inverse of window_x and window_y.
  const double wx = (x / depth - center_x_) / (tan_half_ * pixel_aspect_);
  const double wy = (y / depth - center_y_) / tan_half_;
  return {{(wx * picture_height_ + picture_width_) / 2 + overscan_,
           (1 - wy) * picture_height_ / 2 + overscan_}};
}

Vec3d Camera::direction_towards(const Vec3d& point) const {
  if (projection_ == Projection::orthographic)
    return forward_;
  const Vec3d p = point - origin_;
  if (projection_ == Projection::panorama)
    return length(p) > 0 ? normalize(p) : forward_;
  const double x = dot(p, right_), y = dot(p, up_), z = dot(p, forward_);
  const ViewWindow& view = raster_;
  if (z > 0 && x >= view.x0 * z && x <= view.x1 * z && y >= view.y0 * z && y <= view.y1 * z)
    return normalize(p);
  const double depth = std::max(z, 1e-12 * length(p));
  return normalize(forward_ + right_ * std::clamp(x / depth, view.x0, view.x1) +
                   up_ * std::clamp(y / depth, view.y0, view.y1));
}

bool Camera::may_see(const Boxd& box) const {
  if (projection_ == Projection::panorama)
    return true;
  // The edges of the view at depth z; those of a lens reach farther where it is not in focus.
  const bool parallel = projection_ == Projection::orthographic;
  bool behind = true, right = true, left = true, above = true, below = true;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = box.corner(corner) - origin_;
    const double x = dot(p, right_), y = dot(p, up_), z = dot(p, forward_);
    const double scale = parallel ? 1 : z;
    const double blur = lens_.radius() > 0 ? lens_.radius() * std::abs(1 - z / focus_) : 0;
    behind = behind && z < 0;
    right = right && x > raster_.x1 * scale + blur;
    left = left && -x > -raster_.x0 * scale + blur;
    above = above && y > raster_.y1 * scale + blur;
    below = below && -y > -raster_.y0 * scale + blur;
  }
  return !(behind || right || left || above || below);
}

double Camera::along_axis(const Vec3d& direction) const {
  if (projection_ == Projection::panorama)
    return 1;
  return std::max(dot(direction, forward_), 1e-12);
}

} // namespace vdbeam
