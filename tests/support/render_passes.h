#pragma once

#include "support/memory_scene.h"
#include "support/statistics.h"
#include "support/test_frame.h"

#include <algorithm>
#include <array>
#include <vector>

namespace vdbeam::test {

constexpr int region_rows = 4; ///< and 4 columns

/// The mean over the image of what passes render, per channel, with the passes as samples.
struct PassMeans {
  std::array<Samples, 3> total, direct, indirect, background;
  Samples opacity, depth;
  std::vector<Rgb> pixels; ///< mean over the passes, direct + indirect + background
  /// Mean of the channels: of each pixel, and of each of the rectangles that the picture is cut in.
  std::vector<Samples> brightness, regions;
  RenderStatistics statistics;
};

/// How many of the regions differ by more than chance, at one of ten thousand pictures, and `bias`
/// of the brighter one allow.
inline int regions_apart(const PassMeans& a, const PassMeans& b, double bias) {
  int apart = 0;
  constexpr double level = 1e-4 / (region_rows * region_rows);
  for (std::size_t i = 0; i < a.regions.size(); ++i) {
    const Samples &x = a.regions[i], &y = b.regions[i];
    const double degrees = static_cast<double>(std::min(x.count(), y.count())) - 1;
    const double limit = quantile(complement(boost::math::students_t(degrees), level / 2));
    apart += std::abs(x.mean() - y.mean()) >
             limit * std::hypot(x.error(), y.error()) + bias * std::max(x.mean(), y.mean()) + 1e-6;
  }
  return apart;
}

/// The regions of the picture that is mirrored left and right.
inline PassMeans mirrored(PassMeans means) {
  for (int row = 0; row < region_rows; ++row)
    std::reverse(means.regions.begin() + row * region_rows,
                 means.regions.begin() + (row + 1) * region_rows);
  return means;
}

inline Rgb pixel_total(const PassImage& image, std::size_t i) {
  return image.total(i);
}

inline void add_means(std::array<Samples, 3>& samples, const std::vector<Rgb>& values) {
  for (int c = 0; c < 3; ++c) {
    double sum = 0;
    for (const Rgb& value : values)
      sum += static_cast<double>(value[c]);
    samples[static_cast<std::size_t>(c)].add(sum / static_cast<double>(values.size()));
  }
}

inline void add_regions(std::vector<Samples>& regions, const PassImage& image) {
  regions.resize(region_rows * region_rows);
  std::vector<double> sums(regions.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      sums[static_cast<std::size_t>(y * region_rows / image.height * region_rows +
                                    x * region_rows / image.width)] +=
          static_cast<double>(
              mean_component(pixel_total(image, static_cast<std::size_t>(y) * image.width + x)));
  const double pixels = static_cast<double>(image.direct.size()) / (region_rows * region_rows);
  for (std::size_t i = 0; i < sums.size(); ++i)
    regions[i].add(sums[i] / pixels);
}

/// Renders the passes `first` to `first` + `count` - 1.
inline PassMeans means_of(PassRenderer& estimator, int first, int count) {
  PassMeans means;
  PassImage image;
  std::vector<Vec3d> sums;
  for (int pass = first; pass < first + count; ++pass) {
    estimator.render_pass(pass, image, means.statistics);
    std::vector<Rgb> total;
    for (std::size_t i = 0; i < image.direct.size(); ++i)
      total.push_back(pixel_total(image, i));
    sums.resize(total.size());
    means.brightness.resize(total.size());
    add_regions(means.regions, image);
    double opacity = 0, depth = 0;
    for (std::size_t i = 0; i < total.size(); ++i) {
      sums[i] += Vec3d(total[i]);
      means.brightness[i].add(static_cast<double>(mean_component(total[i])));
      opacity += static_cast<double>(image.opacity[i]);
      depth += static_cast<double>(image.depth[i]);
    }
    add_means(means.total, total);
    add_means(means.direct, image.direct);
    add_means(means.indirect, image.indirect);
    add_means(means.background, image.background);
    means.opacity.add(opacity / static_cast<double>(total.size()));
    means.depth.add(depth / static_cast<double>(total.size()));
  }
  for (const Vec3d& sum : sums)
    means.pixels.push_back(Rgb(sum / static_cast<double>(count)));
  return means;
}

/// Renders passes 0 to `passes` - 1 of a scene.
inline PassMeans render_passes(MemoryScene scene, EstimatorType type, int passes) {
  scene.scene.render.estimator = type;
  const TestFrame frame(scene);
  return means_of(*frame.estimator(), 0, passes);
}

} // namespace vdbeam::test
