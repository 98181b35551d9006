#pragma once

#include "image/deep_layout.h"
#include "math/grouped_light.h"
#include "vdbeam/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vdbeam {

/// Radiance at one pixel, numbered row by row.
struct PixelValue {
  std::size_t pixel;
  Rgb radiance;
};

/// Result of one pass of an estimator: one value per pixel and output, row-major from the top
/// left.
struct PassImage {
  int width = 0, height = 0;
  std::vector<Rgb> direct;     ///< light that was scattered once, whatever found it
  std::vector<Rgb> indirect;   ///< light that was scattered more often
  std::vector<Rgb> background; ///< lights seen through the volume: Tr * escaped radiance
  std::vector<Rgb> emission;   ///< the medium's own light, Tr * j; empty where nothing glows
  /// All light of each group of lights (docs/reference/scene.md); empty without groups.
  std::vector<std::vector<Rgb>> groups;
  std::vector<float> opacity; ///< 1 - Tr of the whole ray (mean over channels)
  /// Opacity times the mean distance [world] at which light is extinguished: the integral of
  /// Tr sigma_t t dt (mean over channels). Its sum over the passes divided by the sum of opacity is
  /// the depth of the medium.
  std::vector<float> depth;
  /// Per object of the scene, how much of each pixel it covers: what it adds to the opacity of the
  /// ray. Empty where nobody asks for it.
  std::vector<std::vector<float>> coverage;
  /// Additional planes that layers need (layers/ray_layers.h).
  std::vector<std::vector<float>> planes;
  /// Where rays are cut for a deep picture; null where nobody asks for one.
  const DeepLayout* deep_layout = nullptr;
  /// Per piece of the layout, the light of the medium (R, G, B) and the opacity that it adds.
  std::vector<float> deep;
  /// At some pixels: the bias of the pass by the width of its kernels and by other blur, as it
  /// follows from what kernels of another width give of the same photons.
  std::vector<PixelValue> blur;
  /// The bias by the forward peak that the pass took out of scattering (similar_medium.h) is
  /// proportional to this; 0: nothing was taken out.
  float truncation = 0;
  /// Per tile of the picture, row by row: whether its pixels that were asked for are finished,
  /// which all of them are unless the pass was stopped; empty where it was stopped before any.
  std::vector<std::uint8_t> finished_tiles;
  static constexpr int tile_width = 16;

  /// `glows`: there is something to hold in `emission`. `group_count`: of groups of lights.
  void resize(int w, int h, bool glows = false, int group_count = 0,
              const DeepLayout* layout = nullptr, std::size_t objects = 0,
              std::size_t plane_count = 0) {
    width = w;
    height = h;
    const std::size_t n = static_cast<std::size_t>(w) * h;
    direct.assign(n, {});
    indirect.assign(n, {});
    background.assign(n, {});
    emission.assign(glows ? n : 0, {});
    groups.assign(static_cast<std::size_t>(group_count), std::vector<Rgb>(n));
    coverage.assign(objects, std::vector<float>(n));
    planes.assign(plane_count, std::vector<float>(n));
    opacity.assign(n, 0);
    depth.assign(n, 0);
    truncation = 0;
    deep_layout = layout;
    deep.assign(layout ? layout->pieces() * DeepLayout::values_per_piece : 0, 0);
    finished_tiles.assign(static_cast<std::size_t>(tile_columns()) *
                              static_cast<std::size_t>((h + tile_width - 1) / tile_width),
                          0);
  }
  int tile_columns() const { return (width + tile_width - 1) / tile_width; }
  std::size_t tile_of(int x, int y) const {
    return static_cast<std::size_t>(y / tile_width) * static_cast<std::size_t>(tile_columns()) +
           static_cast<std::size_t>(x / tile_width);
  }
  /// Adds light to one of the sums above, and the light of each group to the sum of that group.
  void add(std::vector<Rgb> PassImage::*sum, std::size_t pixel, const GroupedLight& light) {
    (this->*sum)[pixel] += light.sum();
    add_to_groups(pixel, light);
  }
  void add_to_groups(std::size_t pixel, const GroupedLight& light) {
    for (std::size_t g = 0; g < std::min(groups.size(), light.parts().size()); ++g)
      groups[g][pixel] += light.parts()[g];
  }
  /// Moves `light`, which was scattered once only, from the pixel's indirect light to its direct
  /// light; it exceeds the indirect light by rounding at most.
  void move_to_direct(std::size_t pixel, const Rgb& light) {
    direct[pixel] += light;
    for (int c = 0; c < 3; ++c) {
      const float whole = indirect[pixel][c], rest = whole - light[c];
      indirect[pixel][c] = std::abs(rest) < 1e-6f * std::abs(whole) ? 0 : rest;
    }
  }
  /// Multiplies what rays have added to the pixel.
  void scale_pixel(std::size_t pixel, float factor) {
    for (std::vector<Rgb>* light : {&direct, &indirect, &background, &emission})
      if (!light->empty())
        (*light)[pixel] *= factor;
    for (std::vector<Rgb>& group : groups)
      group[pixel] *= factor;
    opacity[pixel] *= factor;
    depth[pixel] *= factor;
    for (std::vector<float>& object : coverage)
      object[pixel] *= factor;
    for (std::vector<float>& plane : planes)
      plane[pixel] *= factor;
    if (deep_layout) {
      constexpr std::size_t values = DeepLayout::values_per_piece;
      float* first = deep.data() + deep_layout->first[pixel] * values;
      std::transform(first, first + deep_layout->count(pixel) * values, first,
                     [&](float value) { return value * factor; });
    }
  }
  /// Memory of a pass [bytes].
  static constexpr std::size_t bytes_per_pixel(bool glows) {
    return (glows ? 4 : 3) * sizeof(Rgb) + 2 * sizeof(float);
  }
  /// Total radiance of the pixel.
  Rgb total(std::size_t pixel) const {
    const Rgb sum = direct[pixel] + indirect[pixel] + background[pixel];
    return emission.empty() ? sum : sum + emission[pixel];
  }
};

} // namespace vdbeam
