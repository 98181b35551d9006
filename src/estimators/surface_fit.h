#pragma once

#include "image/pass_image.h"
#include "rays/estimator_input.h"
#include "rays/profile_shading.h"

#include <array>
#include <span>
#include <vector>

namespace vdbeam {

class BlurProbe;

/// What matt surfaces reflect of light that has come by way of other surfaces and the medium has
/// the noise of a few paths per pixel, but it changes slowly over a surface, per albedo. So each
/// pixel takes it from a plane that is fitted to the pixels around it which show the same surface
/// (PlaneFit), within fewer pixels from pass to pass: the bias vanishes as the noise does. Light
/// straight from lights, with its shadows, stays as it is.
class SurfaceFit {
public:
  /// Fit for one pass of a world with surfaces. `input` must outlive this.
  SurfaceFit(const EstimatorInput& input, int pass);

  /// By how many pixels it reaches to each side.
  static constexpr int reach = 3;
  /// Memory of a pass per pixel [bytes].
  static constexpr std::size_t bytes_per_pixel(std::size_t groups);

  /// The pixel shows a surface through the transmittance `tr`. Any thread may call it, one per
  /// pixel.
  void set(std::size_t pixel, const SeenSurface& seen, const Rgb& tr);
  /// One more ray of a pixel that `rays` have shown so far: the pixel has their mean, and is not
  /// fitted where they show several surfaces.
  void add(std::size_t pixel, const SeenSurface& seen, const Rgb& tr, int rays);

  /// After all pixels: replaces their light by what is fitted, in the window. `blur`, unless it is
  /// null, takes how much that blurs.
  void apply(const PixelRegion& window, PassImage& image, BlurProbe* blur = nullptr) const;

private:
  struct Pixel {
    Rgb light;      ///< smooth light per albedo, of all groups of lights
    Rgb factor;     ///< albedo times transmittance
    Vec3f position; ///< render space
    Vec3f normal;
    int surface = -1; ///< -1: none that is fitted
  };
  struct Share {
    std::size_t pixel;
    double weight;
  };
  using Shares = std::array<Share, (2 * reach + 1) * (2 * reach + 1)>;
  std::span<const Share> shares(int x, int y, float radius, Shares& shares) const;
  float farthest_off(int x, int y, float radius) const;
  void fit_pixel(int x, int y, PassImage& image, BlurProbe* blur) const;

  const Camera& camera_;
  int width_, height_;
  float radius_; ///< [pixels]
  std::vector<Pixel> pixels_;
  std::vector<std::vector<Rgb>> groups_; ///< Pixel::light of each group, by pixel
};

constexpr std::size_t SurfaceFit::bytes_per_pixel(std::size_t groups) {
  return sizeof(Pixel) + groups * sizeof(Rgb);
}

} // namespace vdbeam
