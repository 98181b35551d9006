#pragma once

#include "image/pass_image.h"
#include "rays/estimator_input.h"
#include "rays/profile_shading.h"
#include "vdbeam/pass_spec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vdbeam {

class BlurProbe;

/// What matt surfaces reflect of light that has come by way of other surfaces and the medium has
/// the noise of a few paths per pixel, but it changes slowly over a surface, per albedo. So each
/// pixel takes it from a plane that is fitted to the pixels around it which show the same surface
/// (PlaneFit), within fewer pixels from pass to pass: the bias vanishes as the noise does. Then
/// planes are fitted to the results, three times as wide, and count as far as their difference from
/// the narrow ones is no more than noise. Light straight from lights has shadows, and reflections
/// in glossy materials have edges, so the narrow planes count in the same way there, against the
/// noise of the pixels' own samples.
class SurfaceFit {
public:
  /// Fit for one pass of a world with surfaces. `input` must outlive this.
  SurfaceFit(const EstimatorInput& input, const PassSpec& spec);

  /// By how many pixels it reaches to each side: for a narrow plane, for a wide one, and for the
  /// means by which these are compared.
  static constexpr int narrow_reach = 3, wide_step = 3, reach = (2 + wide_step) * narrow_reach;
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
  void apply(const PixelRegion& window, PassImage& image, BlurProbe* blur = nullptr);

  /// How much a plane counts, in a render of `passes` passes, against what has the variance V and a
  /// squared difference from the plane of `difference`, which expects V and the squared bias B of
  /// the plane. `tolerance`: how many times V may be noise.
  static float best_weight(float variance, float difference, int passes, float tolerance = 1);

private:
  struct Pixel {
    Rgb factor;     ///< albedo times transmittance
    Rgb of_gloss;   ///< the same for glossy light
    Vec3f position; ///< render space
    Vec3f normal;
    int surface = -1; ///< -1: none that is fitted
  };
  /// Light of the pixels, and of each group of lights.
  struct Planes {
    std::vector<Rgb> light;
    std::vector<std::vector<Rgb>> groups;
  };
  /// A part of the light: of the pixels themselves, from narrow and from wide planes.
  struct Part {
    Planes own, narrow, wide;
    std::vector<float> variance; ///< of a pixel's own light, mean of channels
  };
  /// The first two are per albedo; the third is there if some material has a glossy part.
  enum PartIndex : std::uint8_t { smooth, straight, gloss, part_count };
  struct Share {
    std::size_t pixel;
    double weight;
  };
  static constexpr int taps = (2 * narrow_reach + 1) * (2 * narrow_reach + 1);
  using Shares = std::array<Share, taps>;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  template <class Visit>
  void visit_neighbours(int x, int y, int step, const Visit& visit) const;
  std::span<const Share> shares(int x, int y, float radius, int step, Shares& shares) const;
  float farthest_off(int x, int y, float radius) const;
  void fit_narrow(int x, int y);
  void fit_wide(int x, int y);
  void fit_pixel(int x, int y, PassImage& image, BlurProbe* blur) const;
  bool is_gloss(const Part& part) const {
    return &part != &parts_[smooth] && &part != &parts_[straight];
  }
  std::array<float, 2> weights_of_planes(const Part& part, int x, int y) const;

  const Camera& camera_;
  int width_, height_;
  int expected_passes_;
  float narrow_, wide_; ///< radii of the planes [pixels, and steps]
  std::vector<Pixel> pixels_;
  std::vector<float> variance_of_narrow_; ///< of a narrow plane over that of a pixel's own light
  std::vector<Part> parts_;
};

constexpr std::size_t SurfaceFit::bytes_per_pixel(std::size_t groups) {
  return sizeof(Pixel) + sizeof(float) +
         part_count * (sizeof(float) + 3 * (1 + groups) * sizeof(Rgb));
}

} // namespace vdbeam
