#include "shading/surface_fit.h"

#include "math/pixel_fit.h"
#include "math/plane_fit.h"
#include "photons/blur_probe.h"
#include "rays/pixel_tiles.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// How far a neighbour may lie off the plane of the surface, in widths of what is shared: other
/// parts of the surface lie much farther off, and its own curvature does not reach so far.
constexpr float farthest_off_plane = 2;

float mean_square(const Rgb& difference) {
  return mean_component(difference * difference);
}

} // namespace

SurfaceFit::SurfaceFit(const EstimatorInput& input, const PassSpec& spec)
    : camera_(input.camera), width_(input.camera.width()), height_(input.camera.height()),
      expected_passes_(spec.expected_passes), narrow_(spec.surface_fit_radius),
      wide_(spec.wide_surface_fit_radius),
      pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      variance_of_narrow_(pixels_.size()),
      parts_(input.world.surfaces->any_gloss() ? part_count : gloss) {
  const auto groups = static_cast<std::size_t>(input.world.lights.group_count());
  for (Part& part : parts_) {
    for (Planes* planes : {&part.own, &part.narrow, &part.wide}) {
      planes->light.resize(pixels_.size());
      planes->groups.assign(groups, std::vector<Rgb>(pixels_.size()));
    }
    part.variance.resize(pixels_.size());
  }
}

void SurfaceFit::set(std::size_t pixel, const SeenSurface& seen, const Rgb& tr) {
  pixels_[pixel] = {seen.albedo * tr, seen.gloss_color * tr, seen.position, seen.normal,
                    seen.surface};
  const auto set_part = [&](Part& part, const GroupedLight& light, float variance) {
    part.variance[pixel] = variance;
    part.own.light[pixel] = light.sum();
    for (std::size_t g = 0; g < light.parts().size(); ++g)
      part.own.groups[g][pixel] = light.parts()[g];
  };
  set_part(parts_[smooth], seen.smooth, 0);
  set_part(parts_[straight], seen.straight, seen.straight_variance);
  if (parts_.size() > gloss)
    set_part(parts_[gloss], seen.gloss, seen.gloss_variance);
}

void SurfaceFit::add(std::size_t index, const SeenSurface& seen, const Rgb& tr, int rays) {
  Pixel& pixel = pixels_[index];
  if (seen.surface != pixel.surface) {
    pixel.surface = -1;
    return;
  }
  const float share = 1 / static_cast<float>(rays + 1);
  const auto join = [share](auto& mean, const auto& value) { mean += (value - mean) * share; };
  const auto join_part = [&](Part& part, const GroupedLight& light, float variance) {
    float& of_mean = part.variance[index];
    of_mean = of_mean * (1 - share) * (1 - share) + variance * share * share;
    join(part.own.light[index], light.sum());
    const auto& parts = light.parts(); // none where there is no light
    for (std::size_t g = 0; g < part.own.groups.size(); ++g)
      join(part.own.groups[g][index], g < parts.size() ? parts[g] : Rgb());
  };
  join_part(parts_[smooth], seen.smooth, 0);
  join_part(parts_[straight], seen.straight, seen.straight_variance);
  if (parts_.size() > gloss)
    join_part(parts_[gloss], seen.gloss, seen.gloss_variance);
  join(pixel.factor, seen.albedo * tr);
  join(pixel.of_gloss, seen.gloss_color * tr);
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

/// Calls visit(pixel, dx, dy) for the pixels that show the same surface, up to 3 steps to each
/// side.
template <class Visit>
void SurfaceFit::visit_neighbours(int x, int y, int step, const Visit& visit) const {
  const int surface = pixels_[index(x, y)].surface;
  for (int dy = -narrow_reach; dy <= narrow_reach; ++dy)
    for (int dx = -narrow_reach; dx <= narrow_reach; ++dx) {
      const int px = x + step * dx, py = y + step * dy;
      if (px < 0 || py < 0 || px >= width_ || py >= height_)
        continue;
      if (const std::size_t i = index(px, py); pixels_[i].surface == surface)
        visit(i, dx, dy);
    }
}

/// The pixels whose weighted sum is what the plane fitted about a pixel has there; none where that
/// is not known. `radius`: in steps of `step` pixels.
std::span<const SurfaceFit::Share> SurfaceFit::shares(int x, int y, float radius, int step,
                                                      Shares& shares) const {
  const float widest = farthest_off(x, y, radius * static_cast<float>(step));
  if (!(widest > 0))
    return {};
  const Pixel& center = pixels_[index(x, y)];
  std::array<std::array<double, 2>, taps> offsets;
  std::size_t count = 0;
  PlaneFit fit;
  visit_neighbours(x, y, step, [&](std::size_t pixel, int dx, int dy) {
    const Pixel& other = pixels_[pixel];
    const float near = 1 - static_cast<float>(dx * dx + dy * dy) / ((radius + 1) * (radius + 1));
    const float turned = (1 - dot(center.normal, other.normal)) / (1 - tuning::least_cosine_of_fit);
    const float off = dot(center.normal, other.position - center.position) / widest;
    if (!(near > 0 && turned < 1 && off * off < 1))
      return;
    const double weight{near * (1 - turned) * (1 - off * off)};
    fit.add(weight, dx, dy);
    offsets[count] = {static_cast<double>(dx), static_cast<double>(dy)};
    shares[count++] = {pixel, weight};
  });
  const std::array<double, 3> row = fit.row();
  for (std::size_t i = 0; i < count; ++i)
    shares[i].weight *= row[0] + row[1] * offsets[i][0] + row[2] * offsets[i][1];
  return {shares.data(), count};
}

namespace {

/// The weighted sum of light of pixels.
template <class Shares>
Rgb sum_of(const Shares& shares, const std::vector<Rgb>& light) {
  Vec3d sum;
  for (const auto& share : shares)
    sum += Vec3d(light[share.pixel]) * share.weight;
  return Rgb(sum);
}

} // namespace

/// From the light of the pixels themselves.
void SurfaceFit::fit_narrow(int x, int y) {
  const std::size_t i = index(x, y);
  Shares buffer;
  std::span<const Share> fitted;
  if (pixels_[i].surface >= 0)
    fitted = shares(x, y, narrow_, 1, buffer);
  const Share alone{i, 1};
  if (fitted.empty())
    fitted = {&alone, 1};
  for (Part& part : parts_) {
    part.narrow.light[i] = sum_of(fitted, part.own.light);
    for (std::size_t g = 0; g < part.own.groups.size(); ++g)
      part.narrow.groups[g][i] = sum_of(fitted, part.own.groups[g]);
  }
  double own = 0, squares = 0;
  for (const Share& share : fitted) {
    own = share.pixel == i ? share.weight : own;
    squares += share.weight * share.weight;
  }
  variance_of_narrow_[i] = static_cast<float>(squares);
  // The plane follows the pixel's own noise by its share of it.
  constexpr double least_rest = 0.1;
  const auto rest = static_cast<float>(std::max(least_rest, 1 - own));
  Part& part = parts_[smooth];
  part.variance[i] = mean_square(part.own.light[i] - part.narrow.light[i]) / rest;
}

/// From what narrow planes have.
void SurfaceFit::fit_wide(int x, int y) {
  const std::size_t i = index(x, y);
  if (pixels_[i].surface < 0)
    return;
  Shares buffer;
  std::span<const Share> fitted = shares(x, y, wide_, wide_step, buffer);
  const Share alone{i, 1};
  if (fitted.empty())
    fitted = {&alone, 1};
  for (Part& part : parts_) {
    part.wide.light[i] = sum_of(fitted, part.narrow.light);
    for (std::size_t g = 0; g < part.own.groups.size(); ++g)
      part.wide.groups[g][i] = sum_of(fitted, part.narrow.groups[g]);
  }
}

/// The mean over n passes to come has the least error at the weight (V / n) / (V / n + B).
float SurfaceFit::best_weight(float variance, float difference, int passes, float tolerance) {
  const float of_mean = variance / static_cast<float>(passes);
  const float bias = std::max(0.0f, difference - tolerance * variance);
  return of_mean + bias > 0 ? of_mean / (of_mean + bias) : 0;
}

/// How much the narrow plane counts against the pixel's own light, and the wide one against the
/// narrow one, by means over the pixels around.
std::array<float, 2> SurfaceFit::weights_of_planes(const Part& part, int x, int y) const {
  float variance = 0, from_narrow = 0, from_wide = 0, count = 0;
  visit_neighbours(x, y, 1, [&](std::size_t i, int, int) {
    variance += part.variance[i];
    from_narrow += mean_square(part.own.light[i] - part.narrow.light[i]);
    if (wide_ > 0)
      from_wide += mean_square(part.wide.light[i] - part.narrow.light[i]);
    ++count;
  });
  variance /= count;
  const float of_narrow = variance * variance_of_narrow_[index(x, y)];
  const float tolerance = is_gloss(part) ? tuning::gloss_tolerance : 1;
  return {&part == &parts_[smooth]
              ? 1
              : best_weight(variance, from_narrow / count, expected_passes_, tolerance),
          wide_ > 0 ? best_weight(of_narrow, from_wide / count, expected_passes_) : 0};
}

void SurfaceFit::fit_pixel(int x, int y, PassImage& image, BlurProbe* blur) const {
  const std::size_t i = index(x, y);
  const Pixel& pixel = pixels_[i];
  if (pixel.surface < 0)
    return;
  PixelValue* const probe = blur ? blur->find(i) : nullptr;
  for (const Part& part : parts_) {
    const Rgb& factor = is_gloss(part) ? pixel.of_gloss : pixel.factor;
    const auto [narrow, wide] = weights_of_planes(part, x, y);
    const auto beyond = [&, narrow = narrow, wide = wide](const auto& planes) { // its own light
      const Rgb by_narrow = planes(part.narrow)[i] - planes(part.own)[i];
      return (wide > 0 ? by_narrow + (planes(part.wide)[i] - planes(part.narrow)[i]) * wide
                       : by_narrow) *
             narrow * factor;
    };
    const auto light = [](const Planes& planes) -> const std::vector<Rgb>& { return planes.light; };
    image.background[i] += beyond(light);
    for (std::size_t g = 0; g < std::min(part.own.groups.size(), image.groups.size()); ++g)
      image.groups[g][i] +=
          beyond([g](const Planes& planes) -> const std::vector<Rgb>& { return planes.groups[g]; });
    if (!probe)
      continue;
    Shares buffer;
    const Rgb narrower = sum_of(shares(x, y, narrower_fit(narrow_), 1, buffer), part.own.light);
    const Rgb of_narrow =
        (part.narrow.light[i] - narrower) * narrow * blur_over_difference(narrow_);
    probe->radiance += of_narrow * factor;
    if (wide > 0)
      probe->radiance += (part.wide.light[i] - part.narrow.light[i]) * (narrow * wide) * factor;
  }
}

void SurfaceFit::apply(const PixelRegion& window, PassImage& image, BlurProbe* blur) {
  const auto for_pixels = [&](int margin, const auto& work) {
    const PixelRegion region = widened(window, margin, camera_);
    tbb::parallel_for(region.y0, region.y1, [&](int y) {
      for (int x = region.x0; x < region.x1; ++x)
        work(x, y);
    });
  };
  for_pixels((1 + wide_step) * narrow_reach, [&](int x, int y) { fit_narrow(x, y); });
  if (wide_ > 0)
    for_pixels(narrow_reach, [&](int x, int y) { fit_wide(x, y); });
  for_pixels(0, [&](int x, int y) { fit_pixel(x, y, image, blur); });
}

} // namespace vdbeam
