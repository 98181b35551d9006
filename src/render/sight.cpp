#include "render/sight.h"

#include "medium/optical_depth.h"
#include "transport/camera_ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace vdbeam {
namespace {

/// Rays across and down at most: few enough to cost nothing.
constexpr int most_columns = 48, most_rows = 27;
/// An optical depth under which nobody sees the medium.
constexpr double invisible = 0.005;

/// Optical depth along a segment, in the channel with most.
double depth_along(const Medium& medium, const Segment& segment) {
  Rgb depth{0, 0, 0};
  medium.for_each_met(segment, [&](std::size_t v) {
    const Volume& volume = medium.volumes[v];
    float sum = 0;
    for_each_piece(volume, segment, [&](float, float, float piece) {
      sum += piece;
      return true;
    });
    depth += volume.channel_scale * sum;
  });
  return static_cast<double>(max_component(depth));
}

void add_ray(const World& world, const Camera& camera, const EyeRay& eye, Sight& sight) {
  const CameraRay ray = camera_ray(world, camera, eye);
  const double scale = world.space.scale;
  ++sight.rays;
  const bool meets = ray.segment.t_begin < ray.segment.t_end;
  if (meets)
    sight.optical_depth = std::max(sight.optical_depth, depth_along(world.medium, ray.segment));
  const auto keep_nearest = [](double distance, double& nearest) {
    nearest = nearest > 0 ? std::min(nearest, distance) : distance;
  };
  const Segment whole = world.medium.clip({ray.ray(), static_cast<float>(-ray.shift), infinity});
  if (whole.t_begin < whole.t_end)
    keep_nearest((static_cast<double>(whole.t_begin) + ray.shift) / scale, sight.medium_begin);
  if (!ray.hit)
    return;
  keep_nearest(ray.hit->t / scale, sight.nearest);
  sight.blocked += !meets;
  sight.inside += dot(Vec3f(eye.direction), ray.hit->normal) > 0;
  sight.surface = sight.surface == -1 || sight.surface == ray.hit->surface ? ray.hit->surface : -2;
}

} // namespace

Sight look_through(const World& world, const Camera& camera, const PixelRegion& window) {
  Sight sight;
  const int columns = std::min(window.width(), most_columns);
  const int rows = std::min(window.height(), most_rows);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x = window.x0 + (i + 0.5) * window.width() / columns;
      const double y = window.y0 + (j + 0.5) * window.height() / rows;
      add_ray(world, camera, camera.ray(x, y), sight);
    }
  return sight;
}

std::vector<std::string> sight_notes(const Scene& scene, const World& world, const Camera& camera,
                                     const Sight& sight) {
  std::vector<std::string> notes;
  // Where volumes move, they may come into view; a small one may lie between the rays.
  if (!scene.moments.empty() || !world.medium.visible() || !may_see_medium(world, camera))
    return notes;
  if (sight.surface >= 0 && sight.inside == sight.rays)
    notes.push_back(
        fmt::format("the camera is inside mesh.{}, which fills the image", sight.surface));
  else if (sight.surface >= 0 && sight.blocked == sight.rays)
    notes.push_back(
        fmt::format("mesh.{} hides every volume: it fills the image, {:.3g} from the camera",
                    sight.surface, sight.nearest));
  if (const auto& far = scene.camera.far;
      far && sight.optical_depth == 0 && sight.medium_begin > *far)
    notes.push_back(fmt::format("camera.far = {} clips every volume; the nearest begins at {:.3g}",
                                *far, sight.medium_begin));
  if (sight.optical_depth > 0 && sight.optical_depth < invisible && !scene.glows())
    notes.push_back(fmt::format("the medium is nearly invisible: its optical depth is {:.2g} at "
                                "most; for 10, multiply volume.0.extinction by {:.1g}",
                                sight.optical_depth, 10 / sight.optical_depth));
  return notes;
}

PictureFacts picture_facts(const Image& image, const Sight& sight) {
  PictureFacts facts;
  facts.optical_depth = sight.optical_depth;
  const ImageChannel* const channels[] = {image.find("R"), image.find("G"), image.find("B")};
  const ImageChannel* const alpha = image.find("A");
  if (!channels[0] || !channels[1] || !channels[2] || channels[0]->data.empty())
    return facts;
  const std::size_t pixels = channels[0]->data.size();
  std::size_t black = 0, over_one = 0;
  double opacity = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float most = std::max({channels[0]->data[i], channels[1]->data[i], channels[2]->data[i]});
    black += !(most > 0);
    over_one += most > 1;
    opacity += alpha ? static_cast<double>(alpha->data[i]) : 0;
  }
  const auto count = static_cast<double>(pixels);
  facts.black = static_cast<double>(black) / count;
  facts.over_one = static_cast<double>(over_one) / count;
  facts.opacity = alpha ? opacity / count : std::numeric_limits<double>::quiet_NaN();
  return facts;
}

std::vector<std::string> picture_notes(const PictureFacts& facts) {
  constexpr double most_over_one = 0.5;
  if (facts.black == 1)
    return {"the image is black: no light reaches the camera"};
  if (facts.over_one > most_over_one)
    return {fmt::format("{:.0f} % of the image is above 1: the lights are strong; a PNG looks too "
                        "bright, an EXR keeps the values",
                        100 * facts.over_one)};
  return {};
}

} // namespace vdbeam
