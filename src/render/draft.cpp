#include "render/draft.h"

#include "machine/stopwatch.h"
#include "rays/profile_shading.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// How far a pixel looks for others of its surface, in pixels of the draft.
constexpr int farthest = 3;
/// Greatest factor of a pixel's light over that of the draft's pixels around it: where the draft
/// has missed a wisp it has missed its light, too.
constexpr float greatest_gain = 2;

/// The same scene in fewer pixels, of the same shape together, and without what drafts leave out.
Scene reduced(const Scene& scene, int reduction) {
  Scene small = scene;
  ImageSettings& image = small.image;
  const auto fewer = [&](int pixels) { return (pixels + reduction - 1) / reduction; };
  const double shape = static_cast<double>(image.width) / image.height;
  image.width = fewer(image.width);
  image.height = fewer(image.height);
  image.pixel_aspect *= shape * image.height / image.width;
  image.deep = image.cryptomatte = false;
  if (small.render.photons) // the same number per pixel
    *small.render.photons /=
        static_cast<std::uint64_t>(reduction) * static_cast<std::uint64_t>(reduction);
  small.layers.clear();
  small.moments.clear();
  for (LightSettings& light : small.lights)
    light.group.clear();
  for (SurfaceSettings& surface : small.surfaces)
    surface.group.clear();
  return small;
}

/// The ray through the middle of a pixel, and its profile.
CameraRay middle_ray(const EstimatorInput& input, int x, int y, DepthProfile& profile) {
  const CameraRay ray = camera_ray(input.world, input.camera, input.camera.ray(x + 0.5, y + 0.5));
  profile.build(input.world.medium, ray.segment, static_cast<float>(input.settings.cutoff));
  return ray;
}

void add(const PassImage& image, PassImage& sum) {
  const auto add_all = [](const auto& values, auto& sums) {
    std::transform(sums.begin(), sums.end(), values.begin(), sums.begin(), std::plus<>());
  };
  add_all(image.direct, sum.direct);
  add_all(image.indirect, sum.indirect);
  add_all(image.background, sum.background);
  add_all(image.emission, sum.emission);
  add_all(image.opacity, sum.opacity);
}

} // namespace

/// Pixel of the draft, per opacity or transmittance.
struct Draft::Seen {
  float opacity = 0, depth = 0; ///< of the medium, as in PassImage
  Rgb direct, indirect, emission;
  int surface = -1; ///< at which its middle ray ends
  Rgb radiance;     ///< of that surface
};

Draft::Draft(const Scene& scene, const PreparedScenePtr& prepared, int reduction,
             const StopToken& stop)
    : scene_(reduced(scene, reduction)), reduction_(reduction) {
  const Stopwatch watch;
  setup_ = std::make_unique<FrameSetup>(
      scene_, prepared,
      PixelRegion{0, 0, scene_.image.raster_width(), scene_.image.raster_height()});
  setup_->input.stop = &stop;
  const bool path = scene.render.estimator == EstimatorType::path;
  renderer_ = std::make_unique<FramePasses>(scene.render.estimator,
                                            path ? setup_->path_input() : setup_->input);
  pilot_seconds_ = watch.seconds();
}

bool Draft::add_pass() {
  const Stopwatch watch;
  PassImage image;
  RenderStatistics uncounted;
  if (!setup_->input.stopped())
    renderer_->render_pass(passes_, image, uncounted);
  if (setup_->input.stopped())
    return false;
  if (passes_ == 0)
    sum_ = std::move(image);
  else
    add(image, sum_);
  ++passes_;
  pass_seconds_ = watch.seconds();
  return true;
}

/// Pixels of the draft.
std::vector<Draft::Seen> Draft::look_through() const {
  const EstimatorInput& input = setup_->input;
  std::vector<Seen> pixels(sum_.direct.size());
  const float share = 1 / static_cast<float>(passes_);
  tbb::parallel_for(0, sum_.height, [&](int y) {
    DepthProfile profile;
    for (int x = 0; x < sum_.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(sum_.width) +
                            static_cast<std::size_t>(x);
      Seen& seen = pixels[i];
      const CameraRay ray = middle_ray(input, x, y, profile);
      const OpacityAndDepth medium = opacity_and_depth(input.world, ray, profile);
      // The opacity of its own rays, unless a surface has made them opaque.
      seen.opacity = input.world.surfaces ? medium.opacity : sum_.opacity[i] * share;
      seen.depth = medium.depth;
      seen.direct = sum_.direct[i] * share;
      seen.indirect = sum_.indirect[i] * share;
      if (!sum_.emission.empty())
        seen.emission = sum_.emission[i] * share;
      const Rgb tr = transmittance(input.world.medium, profile);
      if (ray.hit && max_component(tr) > 0.01f) {
        seen.surface = ray.hit->surface;
        seen.radiance = sum_.background[i] * (share / mean_component(tr));
      }
    }
  });
  return pixels;
}

/// The draft's pixels around a place of the picture, weighted.
struct Draft::Around {
  Seen mean;          ///< per weight of 1; the radiance is that of the surface asked for
  bool opaque = true; ///< all of them
  bool clear = true;  ///< of the medium
};

Draft::Around Draft::around(const std::vector<Seen>& seen, double x, double y, int surface) const {
  Around around;
  float of_surface = 0;
  const int reach = surface >= 0 ? farthest : 1;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const auto tent = [](double d) { return static_cast<float>(std::max(0.0, 1 - d)); };
  for (int j = std::max(0, top - reach + 1); j <= std::min(sum_.height - 1, top + reach); ++j)
    for (int i = std::max(0, left - reach + 1); i <= std::min(sum_.width - 1, left + reach); ++i) {
      const Seen& other = seen[static_cast<std::size_t>(j) * static_cast<std::size_t>(sum_.width) +
                               static_cast<std::size_t>(i)];
      const double dx = std::abs(i - x), dy = std::abs(j - y);
      const float near = tent(dx) * tent(dy);
      around.opaque = around.opaque && other.opacity > 0.999f;
      around.clear = around.clear && other.opacity == 0;
      around.mean.opacity += near * other.opacity;
      around.mean.depth += near * other.depth;
      around.mean.direct += other.direct * near;
      around.mean.indirect += other.indirect * near;
      around.mean.emission += other.emission * near;
      if (surface >= 0 && other.surface == surface) {
        const float far = near + 1e-3f * tent(std::max(dx, dy) / (farthest + 1));
        around.mean.radiance += other.radiance * far;
        of_surface += far;
      }
    }
  if (of_surface > 0)
    around.mean.radiance *= 1 / of_surface;
  return around;
}

/// One pixel of the picture, where the draft is at (x, y).
void Draft::enlarge(const EstimatorInput& full, const std::vector<Seen>& seen, double x, double y,
                    CameraRay ray, std::size_t pixel, DepthProfile& profile,
                    PassImage& image) const {
  const Around near = around(seen, x, y, ray.hit ? ray.hit->surface : -1);
  const Seen& mean = near.mean;
  float opacity = 1;
  if (near.opaque) { // there is nothing to be seen behind, and no edge
    image.opacity[pixel] = 1;
    image.depth[pixel] = mean.depth / mean.opacity;
  } else {
    if (near.clear && !ray.hit)
      ray.segment.t_end = ray.segment.t_begin;
    profile.build(full.world.medium, ray.segment, static_cast<float>(full.settings.cutoff));
    shade_profile(full, ray, profile, pixel, image, {GroupedLight(mean.radiance, -1)});
    opacity = opacity_and_depth(full.world, ray, profile).opacity;
  }
  const float of_medium =
      opacity > 0 ? opacity / std::max(mean.opacity, opacity / greatest_gain) : 0;
  image.direct[pixel] = mean.direct * of_medium;
  image.indirect[pixel] = mean.indirect * of_medium;
  if (!image.emission.empty()) // glows where nothing may be opaque
    image.emission[pixel] = mean.emission;
}

PassImage Draft::enlarged(const EstimatorInput& full) const {
  const std::vector<Seen> seen = look_through();
  PassImage image;
  const Camera& camera = full.camera;
  image.resize(camera.width(), camera.height(), !full.world.medium.emitters.empty());
  const double step_x = static_cast<double>(sum_.width) / camera.width(),
               step_y = static_cast<double>(sum_.height) / camera.height();
  tbb::parallel_for(full.window.y0, full.window.y1, [&](int y) {
    DepthProfile profile;
    for (int x = full.window.x0; x < full.window.x1; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(x);
      const CameraRay ray = camera_ray(full.world, camera, camera.ray(x + 0.5, y + 0.5));
      enlarge(full, seen, (x + 0.5) * step_x - 0.5, (y + 0.5) * step_y - 0.5, ray, pixel, profile,
              image);
    }
  });
  return image;
}

} // namespace vdbeam
