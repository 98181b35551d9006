#pragma once

#include "camera/camera.h"
#include "rays/uneven_pixels.h"

#include <array>
#include <span>

namespace vdbeam {

/// What the walks of a camera ray gather has the noise of few walks, and its neighbours see nearly
/// the same light. At each pixel, light per opacity is therefore taken from a plane fitted to it
/// and to the pixels around by weighted least squares (local linear regression; Fan and Gijbels,
/// *Local Polynomial Modelling and Its Applications*, 1996). The fit is linear in the light, and
/// its weights depend on opacity and depth only, which have next to no noise: so it blurs, but has
/// no other bias, and opacity keeps its edges. Neighbours of another depth do not count.
class PixelRegression {
public:
  /// `radius` [pixels]: 0 shares nothing, 1 with the 8 pixels around. At most `widest`.
  PixelRegression(const Camera& camera, double world_scale, float radius);

  /// The light of the pixel (x, y) is the sum of these weights times that of the pixels.
  struct Share {
    std::size_t pixel; ///< of the rectangle
    float weight;
  };
  static constexpr int widest = 3;
  static constexpr std::size_t most_shares = (2 * widest + 1) * (2 * widest + 1);
  using Shares = std::array<Share, most_shares>;
  /// `x`, `y`: in the rectangle, whose pixels alone are shared. The result lies in `shares`.
  std::span<const Share> shares(const SeenMedium& seen, int x, int y, Shares& shares) const;

  float radius() const { return radius_; }

  /// By how many pixels it reaches to each side.
  int reach() const { return reach_; }

private:
  /// A distance of a neighbour in depth at which it does not count [world]: this many times the
  /// reach.
  float deepest(const SeenMedium& seen, int x, int y, float distance) const;

  const Camera& camera_;
  double world_scale_;
  float radius_;
  int reach_;
};

} // namespace vdbeam
