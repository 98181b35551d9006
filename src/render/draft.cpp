#include "render/draft.h"

#include "choose/choose_estimator.h"
#include "layers/plane_layers.h"
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

/// Where pixels of the raster lie in that of the draft, in units of its pixels, whose middles lie
/// at whole numbers.
struct RasterMap {
  double step_x, step_y;
  int overscan, overscan_of_draft;

  RasterMap(const ImageSettings& full, const ImageSettings& draft)
      : step_x(static_cast<double>(draft.width) / full.width),
        step_y(static_cast<double>(draft.height) / full.height), overscan(full.overscan),
        overscan_of_draft(draft.overscan) {}

  /// Place in the draft of a place `x`, in pixels from the left edge.
  double x(double x) const { return (x - overscan) * step_x + overscan_of_draft - 0.5; }
  double y(double y) const { return (y - overscan) * step_y + overscan_of_draft - 0.5; }
};

/// The pixels of the draft from which those of the window are made.
PixelRegion window_of_draft(const ImageSettings& full, const ImageSettings& draft,
                            const PixelRegion& window) {
  constexpr int margin = 1 + farthest;
  const RasterMap map(full, draft);
  const auto from = [&](double place) {
    return std::max(0, static_cast<int>(std::floor(place)) - margin);
  };
  const auto to = [&](double place, int size) {
    return std::min(size, static_cast<int>(std::ceil(place)) + margin);
  };
  return {from(map.x(window.x0)), from(map.y(window.y0)),
          to(map.x(window.x1), draft.raster_width()), to(map.y(window.y1), draft.raster_height())};
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
  for (std::size_t g = 0; g < sum.groups.size(); ++g)
    add_all(image.groups[g], sum.groups[g]);
}

/// What renders the draft's passes. As `auto` does, it leaves photons where they are rare.
std::unique_ptr<PassRenderer> make_renderer(const Scene& scene, const FrameSetup& setup) {
  EstimatorType type = scene.render.estimator;
  if (type == EstimatorType::automatic && why_photons_are_rare(setup.input))
    type = EstimatorType::path;
  const EstimatorInput input = type == EstimatorType::path ? setup.path_input() : setup.input;
  return make_pass_renderer(type, input);
}

} // namespace

Scene reduced(const Scene& scene, int reduction) {
  Scene small = scene;
  ImageSettings& image = small.image;
  const auto fewer = [&](int pixels) { return (pixels + reduction - 1) / reduction; };
  const double shape = static_cast<double>(image.width) / image.height;
  image.width = fewer(image.width);
  image.height = fewer(image.height);
  image.overscan = fewer(image.overscan);
  image.pixel_aspect *= shape * image.height / image.width;
  image.deep = image.cryptomatte = false;
  if (small.render.photons) // the same number per pixel
    *small.render.photons /=
        static_cast<std::uint64_t>(reduction) * static_cast<std::uint64_t>(reduction);
  small.layers.clear();
  small.moments.clear();
  return small;
}

/// Pixel of the draft, per opacity or transmittance.
struct Draft::Seen {
  float opacity = 0, depth = 0; ///< of the medium, as in PassImage
  Rgb direct, indirect, emission;
  int surface = -1; ///< at which its middle ray ends
  Rgb radiance;     ///< of that surface
};

bool Draft::can_show(const Scene& scene) {
  for (const std::string& layer : volume_layer_names(scene))
    if (asks_for_layer(scene, "volumes") || asks_for_layer(scene, layer))
      return false;
  return !scene.image.deep;
}

Draft::Draft(const Scene& scene, const PreparedScenePtr& prepared, const PixelRegion& window,
             int reduction, const StopToken& stop)
    : picture_(scene.image), scene_(reduced(scene, reduction)), reduction_(reduction),
      window_(window_of_draft(scene.image, scene_.image, window)) {
  const Stopwatch watch;
  setup_ = std::make_unique<FrameSetup>(scene_, prepared, window_);
  setup_->input.stop = &stop;
  renderer_ = make_renderer(scene_, *setup_);
  pilot_seconds_ = watch.seconds();
}

Draft::~Draft() = default;

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

/// Sets the pixels of the draft.
void Draft::look_through() {
  const EstimatorInput& input = setup_->input;
  seen_.assign(sum_.direct.size(), {});
  const float share = 1 / static_cast<float>(passes_);
  const std::size_t groups = sum_.groups.size();
  group_light_.assign(groups, std::vector<Rgb>(groups > 0 ? seen_.size() : 0));
  PassImage behind; // the lights that are seen through the medium
  if (groups > 0)
    behind.resize(sum_.width, sum_.height, false, static_cast<int>(groups), nullptr, 0, 0);
  tbb::parallel_for(window_.y0, window_.y1, [&](int y) {
    DepthProfile profile;
    for (int x = window_.x0; x < window_.x1; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(sum_.width) +
                            static_cast<std::size_t>(x);
      Seen& seen = seen_[i];
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
      if (groups > 0)
        shade_profile(input, ray, profile, i, behind);
      for (std::size_t g = 0; g < groups; ++g)
        group_light_[g][i] = max(sum_.groups[g][i] * share - behind.groups[g][i], Rgb(0));
    }
  });
}

/// A place in the draft, from which pixels as far as `reach` are in its window.
struct Draft::Place {
  double x, y;

  /// Calls visit(pixel, dx, dy) for the pixels around, at their distances.
  template <class Visit>
  void visit(const PixelRegion& window, int width, int reach, const Visit& visit) const {
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    for (int j = std::max(window.y0, top - reach + 1); j <= std::min(window.y1 - 1, top + reach);
         ++j)
      for (int i = std::max(window.x0, left - reach + 1);
           i <= std::min(window.x1 - 1, left + reach); ++i)
        visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(i),
              std::abs(i - x), std::abs(j - y));
  }

  static float tent(double d) { return static_cast<float>(std::max(0.0, 1 - d)); }
};

/// The draft's pixels around a place of the picture, weighted.
struct Draft::Around {
  Seen mean;          ///< per weight of 1; the radiance is that of the surface asked for
  bool opaque = true; ///< all of them
  bool clear = true;  ///< of the medium
};

Draft::Around Draft::around(const Place& place, int surface) const {
  Around around;
  float of_surface = 0;
  const int reach = surface >= 0 ? farthest : 1;
  place.visit(window_, sum_.width, reach, [&](std::size_t pixel, double dx, double dy) {
    const Seen& other = seen_[pixel];
    const float near = Place::tent(dx) * Place::tent(dy);
    around.opaque = around.opaque && other.opacity > 0.999f;
    around.clear = around.clear && other.opacity == 0;
    around.mean.opacity += near * other.opacity;
    around.mean.depth += near * other.depth;
    around.mean.direct += other.direct * near;
    around.mean.indirect += other.indirect * near;
    around.mean.emission += other.emission * near;
    if (surface >= 0 && other.surface == surface) {
      const float far = near + 1e-3f * Place::tent(std::max(dx, dy) / (farthest + 1));
      around.mean.radiance += other.radiance * far;
      of_surface += far;
    }
  });
  if (of_surface > 0)
    around.mean.radiance *= 1 / of_surface;
  return around;
}

/// Divides the light of a pixel among the groups. Its groups hold the lights behind already, which
/// are known for every pixel; the rest is divided as in the draft's pixels around, if possible in
/// those that end at the same surface, or at none: else edges would have a fringe of light that
/// belongs beyond them.
void Draft::share_among_groups(const Place& place, int surface, std::size_t pixel,
                               PassImage& image) const {
  constexpr float of_far = 1e-3f, of_other_surface = 1e-4f; // where there is nothing better
  const int reach = setup_->input.world.surfaces ? farthest : 1;
  std::vector<Rgb> around(image.groups.size());
  place.visit(window_, sum_.width, reach, [&](std::size_t other, double dx, double dy) {
    float weight =
        Place::tent(dx) * Place::tent(dy) + of_far * Place::tent(std::max(dx, dy) / (farthest + 1));
    if (seen_[other].surface != surface)
      weight *= of_other_surface;
    for (std::size_t g = 0; g < around.size(); ++g)
      around[g] += group_light_[g][other] * weight;
  });
  Rgb sum, rest = image.total(pixel);
  for (std::size_t g = 0; g < around.size(); ++g) {
    sum += around[g];
    rest = rest - image.groups[g][pixel];
  }
  const auto groups = static_cast<float>(around.size());
  for (std::size_t g = 0; g < around.size(); ++g)
    for (int c = 0; c < 3; ++c)
      image.groups[g][pixel][c] += rest[c] * (sum[c] > 0 ? around[g][c] / sum[c] : 1 / groups);
}

/// One pixel of the picture, where the draft is at `place`.
void Draft::enlarge(const EstimatorInput& full, const Place& place, CameraRay ray,
                    std::size_t pixel, DepthProfile& profile, PassImage& image) const {
  const Around near = around(place, ray.hit ? ray.hit->surface : -1);
  const Seen& mean = near.mean;
  const bool plain = image.coverage.empty() && image.planes.empty();
  float opacity = 1;
  if (near.opaque && plain) { // there is nothing to be seen behind, and no edge
    image.opacity[pixel] = 1;
    image.depth[pixel] = mean.depth / mean.opacity;
  } else {
    if (near.clear && !ray.hit)
      ray.segment.t_end = ray.segment.t_begin;
    profile.build(full.world.medium, ray.segment, static_cast<float>(full.settings.cutoff));
    opacity =
        shade_profile(full, ray, profile, pixel, image, {GroupedLight(mean.radiance, -1)}).opacity;
  }
  const float of_medium =
      opacity > 0 ? opacity / std::max(mean.opacity, opacity / greatest_gain) : 0;
  image.direct[pixel] = mean.direct * of_medium;
  image.indirect[pixel] = mean.indirect * of_medium;
  if (!image.emission.empty()) // glows where nothing may be opaque
    image.emission[pixel] = mean.emission;
  if (!image.groups.empty())
    share_among_groups(place, ray.hit ? ray.hit->surface : -1, pixel, image);
}

PassImage Draft::enlarged(const EstimatorInput& full, const PixelRegion& part) const {
  PassImage image;
  image.resize(part.width(), part.height(), !full.world.medium.emitters.empty(),
               static_cast<int>(sum_.groups.size()), nullptr, full.object_count(),
               full.plane_count());
  const RasterMap map(picture_, scene_.image);
  tbb::parallel_for(part.y0, part.y1, [&](int y) {
    DepthProfile profile;
    for (int x = part.x0; x < part.x1 && !(full.stop && full.stop->requested()); ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y - part.y0) * static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(x - part.x0);
      const CameraRay ray = camera_ray(full.world, full.camera, full.camera.ray(x + 0.5, y + 0.5));
      enlarge(full, {map.x(x + 0.5), map.y(y + 0.5)}, ray, pixel, profile, image);
    }
  });
  return image;
}

} // namespace vdbeam
