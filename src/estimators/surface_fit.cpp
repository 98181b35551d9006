#include "estimators/surface_fit.h"

#include "estimators/gather/regression.h"
#include "math/plane_fit.h"
#include "photons/blur_probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Normals at which a neighbour does not count: at 26 degrees; and how far it may lie off the plane
/// of the surface, in widths of what is shared.
constexpr float least_cosine = 0.9f, farthest_off_plane = 2;

/// Pixels around over which a pass fits.
float radius_of(int pass) {
  constexpr std::array<std::pair<int, float>, 6> radii{
      {{4, 2.8f}, {12, 2}, {32, 1.4f}, {80, 1}, {200, 0.7f}, {600, 0.5f}}};
  for (const auto& [end, radius] : radii)
    if (pass < end)
      return radius;
  return 0.25f;
}

} // namespace

SurfaceFit::SurfaceFit(const EstimatorInput& input, int pass)
    : camera_(input.camera), width_(input.camera.width()), height_(input.camera.height()),
      radius_(radius_of(pass)),
      pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      groups_(static_cast<std::size_t>(input.world.lights.group_count()),
              std::vector<Rgb>(pixels_.size())) {}

void SurfaceFit::set(std::size_t pixel, const SeenSurface& seen, const Rgb& tr) {
  pixels_[pixel] = {seen.smooth.sum(), seen.albedo * tr, seen.position, seen.normal, seen.surface};
  for (std::size_t g = 0; g < seen.smooth.parts().size(); ++g)
    groups_[g][pixel] = seen.smooth.parts()[g];
}

void SurfaceFit::add(std::size_t index, const SeenSurface& seen, const Rgb& tr, int rays) {
  Pixel& pixel = pixels_[index];
  if (seen.surface != pixel.surface) {
    pixel.surface = -1;
    return;
  }
  const float share = 1 / static_cast<float>(rays + 1);
  const auto join = [share](Rgb& mean, const Rgb& value) { mean += (value - mean) * share; };
  join(pixel.light, seen.smooth.sum());
  join(pixel.factor, seen.albedo * tr);
  const auto& parts = seen.smooth.parts(); // none where there is no light
  for (std::size_t g = 0; g < groups_.size(); ++g)
    join(groups_[g][index], g < parts.size() ? parts[g] : Rgb());
}

/// How far a neighbour may lie off the plane of the surface at a pixel, for a fit of this radius.
float SurfaceFit::farthest_off(int x, int y, float radius) const {
  const Pixel& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(x)];
  const Vec3d eye = camera_.ray(x + 0.5, y + 0.5).origin;
  const double pixel_width =
      camera_.pixel_width(x + 0.5, y + 0.5, length(Vec3d(pixel.position) - eye));
  return static_cast<float>(farthest_off_plane * pixel_width) * (radius + 0.5f);
}

/// The pixels whose weighted sum is what the plane fitted about a pixel has there; none where that
/// is not known.
std::span<const SurfaceFit::Share> SurfaceFit::shares(int x, int y, float radius,
                                                      Shares& shares) const {
  const float widest = farthest_off(x, y, radius);
  if (!(widest > 0))
    return {};
  const auto index = [&](int px, int py) {
    return static_cast<std::size_t>(py) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(px);
  };
  const Pixel& center = pixels_[index(x, y)];
  std::array<std::array<double, 2>, std::tuple_size_v<Shares>> offsets;
  std::size_t count = 0;
  PlaneFit fit;
  for (int py = std::max(0, y - reach); py <= std::min(height_ - 1, y + reach); ++py)
    for (int px = std::max(0, x - reach); px <= std::min(width_ - 1, x + reach); ++px) {
      const Pixel& other = pixels_[index(px, py)];
      const auto dx = static_cast<float>(px - x), dy = static_cast<float>(py - y);
      const float near = 1 - (dx * dx + dy * dy) / ((radius + 1) * (radius + 1));
      if (other.surface != center.surface || !(near > 0))
        continue;
      const float turned = (1 - dot(center.normal, other.normal)) / (1 - least_cosine);
      const float off = dot(center.normal, other.position - center.position) / widest;
      const float weight = near * std::max(0.0f, 1 - turned) * std::max(0.0f, 1 - off * off);
      if (!(weight > 0))
        continue;
      fit.add(static_cast<double>(weight), px - x, py - y);
      offsets[count] = {static_cast<double>(px - x), static_cast<double>(py - y)};
      shares[count++] = {index(px, py), static_cast<double>(weight)};
    }
  const std::array<double, 3> row = fit.row();
  for (std::size_t i = 0; i < count; ++i)
    shares[i].weight *= row[0] + row[1] * offsets[i][0] + row[2] * offsets[i][1];
  return {shares.data(), count};
}

void SurfaceFit::fit_pixel(int x, int y, PassImage& image, BlurProbe* blur) const {
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  const Pixel& pixel = pixels_[i];
  Shares buffer;
  std::span<const Share> fitted;
  if (pixel.surface >= 0)
    fitted = shares(x, y, radius_, buffer);
  if (fitted.empty())
    return;
  const auto sum_of = [&](const auto& light) {
    Vec3d sum;
    for (const Share& share : fitted)
      sum += Vec3d(light(share.pixel)) * share.weight;
    return Rgb(sum);
  };
  const auto whole = [&](std::size_t at) { return pixels_[at].light; };
  const Rgb light = sum_of(whole);
  image.background[i] += (light - pixel.light) * pixel.factor;
  for (std::size_t g = 0; g < std::min(groups_.size(), image.groups.size()); ++g)
    image.groups[g][i] +=
        (sum_of([&](std::size_t at) { return groups_[g][at]; }) - groups_[g][i]) * pixel.factor;
  if (PixelValue* probe = blur ? blur->find(i) : nullptr) {
    fitted = shares(x, y, PixelRegression::narrower(radius_), buffer);
    probe->radiance +=
        (light - sum_of(whole)) * pixel.factor * PixelRegression::blur_over_difference(radius_);
  }
}

void SurfaceFit::apply(const PixelRegion& window, PassImage& image, BlurProbe* blur) const {
  tbb::parallel_for(window.y0, window.y1, [&](int y) {
    for (int x = window.x0; x < window.x1; ++x)
      fit_pixel(x, y, image, blur);
  });
}

} // namespace vdbeam
