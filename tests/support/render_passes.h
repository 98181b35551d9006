#pragma once

#include "support/memory_scene.h"
#include "support/statistics.h"
#include "support/test_frame.h"

#include <array>
#include <vector>

namespace vdbeam::test {

/// The mean over the image of what passes render, per channel, with the passes as samples.
struct PassMeans {
  std::array<Samples, 3> total, direct, indirect, background;
  Samples opacity, depth;
  std::vector<Rgb> pixels; ///< mean over the passes, direct + indirect + background
  RenderStatistics statistics;
};

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

/// Renders passes 0 to `passes` - 1 of a scene.
inline PassMeans render_passes(MemoryScene scene, EstimatorType type, int passes) {
  scene.scene.render.estimator = type;
  const TestFrame frame(scene);
  const std::unique_ptr<Estimator> estimator = frame.estimator();
  PassMeans means;
  PassImage image;
  std::vector<Vec3d> sums;
  for (int pass = 0; pass < passes; ++pass) {
    estimator->render_pass(pass, image, means.statistics);
    std::vector<Rgb> total;
    for (std::size_t i = 0; i < image.direct.size(); ++i)
      total.push_back(pixel_total(image, i));
    sums.resize(total.size());
    double opacity = 0, depth = 0;
    for (std::size_t i = 0; i < total.size(); ++i) {
      sums[i] += Vec3d(total[i]);
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
    means.pixels.push_back(Rgb(sum / static_cast<double>(passes)));
  return means;
}

} // namespace vdbeam::test
