#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbeam {

/// Where the camera rays of each pixel are cut into pieces, so that light and opacity are
/// accumulated by depth. Every pixel that is wanted has at least one piece; the first takes what
/// lies before it too, and the last what lies behind it.
struct DeepLayout {
  std::vector<std::uint32_t> first; ///< per pixel, its first piece; and the number of all pieces
  /// Distances from the camera [world] that bound the pieces: n + 1 for a pixel with n pieces, none
  /// for one without.
  std::vector<float> edges;
  std::vector<std::size_t> first_edge; ///< per pixel
  std::vector<float> cosines;          ///< per pixel, depth over distance
  /// The most by which the opacity up to some depth is wrong where pieces count as homogeneous.
  float alpha_error = 0;

  std::size_t pixels() const { return first.empty() ? 0 : first.size() - 1; }
  std::size_t pieces() const { return first.empty() ? 0 : first.back(); }
  std::size_t count(std::size_t pixel) const { return first[pixel + 1] - first[pixel]; }
  const float* edges_of(std::size_t pixel) const { return edges.data() + first_edge[pixel]; }

  /// A pass holds light (R, G, B) and opacity for each piece.
  static constexpr std::size_t values_per_piece = 4;
};

} // namespace vdbeam
