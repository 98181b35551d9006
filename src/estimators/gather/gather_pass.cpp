#include "estimators/gather/gather_pass.h"

#include "estimators/beam/beam_ray.h"
#include "estimators/gather/final_gather.h"
#include "math/pixel_fit.h"
#include "photons/blur_probe.h"
#include "rays/pixel_tiles.h"

namespace vdbeam {

GatherPass::GatherPass(const EstimatorInput& input, const PhotonPass& photons, const PassSpec& spec)
    : wide_(input), window_(wanted(input)), photons_(photons),
      surfaces_(surface_lighting(input, photons)),
      regression_(input.camera, input.world.space.scale, spec.regression_radius),
      narrow_(input.camera, input.world.space.scale, narrower_fit(regression_.radius())),
      blur_over_difference_(vdbeam::blur_over_difference(regression_.radius())),
      walks_(spec.gather_walks) {
  wide_.window = widened(window_, regression_.reach(), input.camera);
  const auto pixels = static_cast<std::size_t>(input.camera.width()) *
                      static_cast<std::size_t>(input.camera.height());
  walked_.direct.resize(pixels);
  walked_.indirect.resize(pixels);
  walked_.groups.assign(static_cast<std::size_t>(input.world.lights.group_count()),
                        std::vector<Rgb>(pixels));
  if (input.world.surfaces) {
    walked_.opacity.resize(pixels);
    walked_.depth.resize(pixels);
  }
  if (input.layers && input.layers->tells_volumes())
    walked_.planes.assign(input.plane_count(), std::vector<float>(pixels));
}

void GatherPass::gather(TileScratch& scratch, const RngKey& key, BlurProbe& blur,
                        PassImage& image) {
  const World& world = photons_.world();
  const PhotonMap* compared = wide_.blur_pixels ? &photons_.compared_map() : nullptr;
  const PhotonMap* caustics = photons_.caustics().size() > 0 ? &photons_.caustics() : nullptr;
  const FinalGather gather(world, photons_.plan(), {photons_.map(), nullptr, caustics}, surfaces_);
  const FinalGather twice(world, photons_.plan(), {photons_.map(), compared, caustics}, surfaces_);
  for (int i = 0; i < TileRays::count && !wide_.stopped(); ++i) {
    const TileRays::PixelRay& ray = scratch.rays[i];
    if (!ray.inside)
      continue;
    PixelValue* probe = blur.find(ray.pixel);
    const std::span<const TileRays::PixelRay> more = scratch.rays.more(i);
    const int rays = 1 + static_cast<int>(more.size());
    // A ray that is one of several needs two walks at least, or its noise would be that of one.
    const int walks = more.empty() ? walks_ : std::max(2, walks_ / rays);
    GatheredLight sum;
    if (world.surfaces) {
      walked_.opacity[ray.pixel] = scratch.medium[static_cast<std::size_t>(i)].opacity;
      walked_.depth[ray.pixel] = scratch.medium[static_cast<std::size_t>(i)].depth;
    }
    const auto send = [&](const TileRays::PixelRay& from) {
      const float ray_weight = 1 / static_cast<float>(rays);
      if (from.profile.empty())
        return;
      Rng rng(key, RngStage::final_gather, from.stream);
      const GatheredLight light =
          (probe ? twice : gather)
              .gather(from.camera.ray(), from.profile, walks, ray_weight, rng, scratch.statistics,
                      RaySink(world, from.camera, wide_.layers, from.pixel, image, walked_));
      sum.direct += light.direct;
      sum.indirect += light.indirect;
      sum.blur += light.blur;
      ++scratch.statistics.lookups;
      if (caustics)
        add_caustics(from, ray_weight, image);
    };
    send(ray);
    for (const TileRays::PixelRay& one : more)
      send(one);
    walked_.add(&PassImage::direct, ray.pixel, sum.direct);
    walked_.add(&PassImage::indirect, ray.pixel, sum.indirect);
    if (probe)
      probe->radiance = sum.blur * BlurProbe::bias_over_difference(BlurProbe::width_of_walks);
  }
}

/// Light that mirrors and glass brought and the medium scattered into the ray: by equation 11,
/// since walks leave it out. It is not fitted to the pixels around, which would blur the caustic.
void GatherPass::add_caustics(const TileRays::PixelRay& ray, float weight, PassImage& image) const {
  const WeightSettings all = weight_settings(photons_, wide_.settings.store);
  const auto caustics = [&](const WeightSettings& weights) {
    return beam_radiance(photons_, photons_.caustics_along_rays(), weights, ray.camera,
                         ray.profile);
  };
  GroupedLight light = caustics(all);
  const RaySink sink(wide_.layers, ray.pixel, image);
  sink.add_sum(&PassImage::direct, light *= weight);
  sink.add_by_opacity(light.sum());
  if (sink.sorts_by_volume())
    for_each_volume_alone(photons_, all, [&](const WeightSettings& weights, std::size_t setting) {
      sink.add_of_volume(setting, caustics(weights).sum() * weight);
    });
}

/// Whether the tile and those around it that are wanted are finished.
bool GatherPass::finished_around(int column, int row, const PassImage& image) const {
  for (int r = row - 1; r <= row + 1; ++r)
    for (int c = column - 1; c <= column + 1; ++c) {
      const int x = c * tile_width, y = r * tile_width;
      const PixelRegion& window = wide_.window;
      const bool wanted = x < window.x1 && x + tile_width > window.x0 && y < window.y1 &&
                          y + tile_width > window.y0;
      if (wanted && !image.finished_tiles[image.tile_of(x, y)])
        return false;
    }
  return true;
}

void GatherPass::fit(BlurProbe& blur, PassImage& image) const {
  const int columns = image.tile_columns();
  std::vector<std::uint8_t> finished(image.finished_tiles.size(), 0);
  tbb::parallel_for(std::size_t{0}, finished.size(), [&](std::size_t tile) {
    const int column = static_cast<int>(tile) % columns, row = static_cast<int>(tile) / columns;
    if (!finished_around(column, row, image))
      return;
    const int x0 = column * tile_width, y0 = row * tile_width;
    for (int y = std::max(y0, window_.y0); y < std::min(y0 + tile_width, window_.y1); ++y)
      for (int x = std::max(x0, window_.x0); x < std::min(x0 + tile_width, window_.x1); ++x)
        fit_pixel(x, y, blur, image);
    finished[tile] = 1;
  });
  image.finished_tiles = std::move(finished);
}

/// The weighted sum of what the walks of pixels found.
Rgb GatherPass::fitted(const std::vector<Rgb>& walked,
                       std::span<const PixelRegression::Share> shares) {
  Rgb light;
  for (const PixelRegression::Share& share : shares)
    light += walked[share.pixel] * share.weight;
  return light;
}

void GatherPass::fit_pixel(int x, int y, BlurProbe& blur, PassImage& image) const {
  const PassImage& medium = walked_.opacity.empty() ? image : walked_;
  const SeenMedium seen{
      0, 0, image.width, image.height, medium.opacity.data(), medium.depth.data()};
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x);
  PixelRegression::Shares buffer;
  const auto all = [&](std::span<const PixelRegression::Share> shares) {
    return fitted(walked_.direct, shares) + fitted(walked_.indirect, shares);
  };
  if (PixelValue* probe = blur.find(pixel)) {
    const Rgb narrow = all(narrow_.shares(seen, x, y, buffer));
    probe->radiance +=
        (all(regression_.shares(seen, x, y, buffer)) - narrow) * blur_over_difference_;
  }
  const std::span<const PixelRegression::Share> shares = regression_.shares(seen, x, y, buffer);
  const Rgb direct = fitted(walked_.direct, shares), indirect = fitted(walked_.indirect, shares);
  image.direct[pixel] += direct;
  image.indirect[pixel] = indirect;
  for (std::size_t g = 0; g < image.groups.size(); ++g)
    image.groups[g][pixel] += fitted(walked_.groups[g], shares);
  for (std::size_t plane = 0; plane < walked_.planes.size(); ++plane)
    for (const PixelRegression::Share& share : shares)
      image.planes[plane][pixel] += walked_.planes[plane][share.pixel] * share.weight;
  RaySink(wide_.layers, pixel, image)
      .add_by_opacity(direct + indirect - walked_.direct[pixel] - walked_.indirect[pixel]);
}

} // namespace vdbeam
