#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vdbeam {

/// An image with samples by depth in each pixel, in order and without overlap. A sample is a piece
/// of the medium that is homogeneous from z to z_back, as OpenEXR defines volume samples.
struct DeepImage {
  int width = 0, height = 0;
  std::vector<std::uint32_t> counts; ///< samples of each pixel, row by row from the top left
  /// Per sample, pixel after pixel: depth [world] where it begins and ends,
  std::vector<float> z, z_back;
  /// radiance and opacity of the sample alone, premultiplied.
  std::vector<float> r, g, b, a;
  /// Greatest error of the opacity up to any depth, because samples are homogeneous.
  float alpha_error = 0;

  /// The flat image of the samples composited over each other: R, G, B and A of each pixel.
  std::vector<std::array<float, 4>> flatten() const;
};

} // namespace vdbeam
