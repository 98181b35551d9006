#pragma once

#include "estimators/gather/final_gather.h"
#include "estimators/gather/regression.h"
#include "photons/photon_pass.h"
#include "shading/tile_shading.h"
#include "vdbeam/pass_spec.h"

#include <span>

namespace vdbeam {

class BlurProbe;

/// The camera side of a pass of final gathering: walks from the rays of all pixels, and then the
/// fit of what they found to the pixels around.
class GatherPass {
public:
  /// The arguments must outlive this. The image has the camera's size.
  GatherPass(const EstimatorInput& input, const PhotonPass& photons, const PassSpec& spec);

  /// The input, its window widened to the pixels to which those that are wanted are fitted.
  const EstimatorInput& input() const { return wide_; }

  /// Sends the walks of a tile's rays; of any thread, each tile once.
  void gather(TileScratch& scratch, const RngKey& key, BlurProbe& blur, PassImage& image);

  /// After all tiles: adds the fitted light to `image`, which has the pixels' opacity and depth.
  /// Tiles around which some were not finished are no longer finished themselves.
  void fit(BlurProbe& blur, PassImage& image) const;

  /// Memory of a pass beyond its image [bytes]; light groups and layers of volumes count twice.
  static constexpr std::size_t bytes_per_pixel(std::size_t groups) {
    return (2 + groups) * sizeof(Rgb);
  }

private:
  void add_caustics(const TileRays::PixelRay& ray, float weight, PassImage& image) const;
  void fit_pixel(int x, int y, BlurProbe& blur, PassImage& image) const;
  /// The weighted sum of what the walks of pixels found.
  static Rgb fitted(const std::vector<Rgb>& walked, std::span<const PixelRegression::Share> shares);
  bool finished_around(int column, int row, const PassImage& image) const;

  EstimatorInput wide_;
  PixelRegion window_; ///< of pixels that are wanted
  const PhotonPass& photons_;
  SurfaceLighting surfaces_;
  PixelRegression regression_, narrow_; ///< the latter shows how much the former blurs
  float blur_over_difference_; ///< all that the fit blurs over what it blurs beyond the narrow one
  int walks_;                  ///< of a ray
  /// Light gathered by the walks of each pixel and, among surfaces, its medium's opacity and depth.
  PassImage walked_;
};

} // namespace vdbeam
