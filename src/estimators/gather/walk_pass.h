#pragma once

#include "estimators/gather/final_gather.h"
#include "estimators/tile_shading.h"
#include "photons/photon_pass.h"
#include "photons/walk_sharing.h"

#include <span>

namespace vdbeam {

class BlurProbe;

/// The camera side of a pass that gathers finally: walks from the rays of all pixels, and then
/// what they share with the pixels around.
class WalkPass {
public:
  /// The arguments must outlive this. The picture has as many pixels as the camera.
  WalkPass(const EstimatorInput& input, const PhotonPass& photons, int pass);

  /// The input, its window widened to the pixels with which those that are wanted share.
  const EstimatorInput& input() const { return wide_; }

  /// Sends the walks of a tile's rays; of any thread, each tile once.
  void gather(TileScratch& scratch, const RngKey& key, BlurProbe& blur, PassImage& image);

  /// After all tiles: adds what pixels share to `image`, which has their opacity and depth. Tiles
  /// around which some were not finished are no longer finished themselves.
  void share(BlurProbe& blur, PassImage& image) const;

  /// What a pass takes beyond its picture; layers of volumes twice.
  static constexpr std::size_t bytes_per_pixel() { return 2 * sizeof(Rgb); }

private:
  void share_pixel(int x, int y, BlurProbe& blur, PassImage& image) const;
  /// What the walks of the pixel found once it is shared.
  GatheredLight shared(std::span<const WalkSharing::Share> shares) const;
  bool finished_around(int column, int row, const PassImage& image) const;

  EstimatorInput wide_;
  PixelRegion window_; ///< of pixels that are wanted
  const PhotonPass& photons_;
  WalkSharing sharing_, narrow_; ///< the latter tells how much the former blurs
  float blur_over_difference_;   ///< all that sharing blurs over what it blurs beyond narrower
  int walks_;                    ///< of a ray
  PassImage walked_;             ///< what the walks of each pixel gathered
};

} // namespace vdbeam
