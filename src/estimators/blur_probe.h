#pragma once

#include "estimators/photon_pass.h"
#include "estimators/tile_rays.h"

#include <utility>

namespace vdbeam {

/// Tells how much kernels blur: at some pixels of a pass the photons are gathered once more, in
/// narrower kernels. The differences have little noise, since both see the same photons, and their
/// mean over the passes tends to a known part of the kernels' bias (docs/physics.md, "Errors").
class BlurProbe {
public:
  /// Of the input's blur pixels. `photons` must outlive this.
  BlurProbe(const EstimatorInput& input, const PhotonPass& photons);

  /// Fills in the pixels of a tile that has been gathered; tiles may come in any order and from any
  /// thread. gathered(i): what ray i of the tile gathered from the photons.
  template <class Gathered>
  void probe(const TileRays& rays, const BeamTile& tile, const Gathered& gathered) {
    for (int i = 0; i < TileRays::count && !values_.empty(); ++i)
      if (PixelValue* value = rays[i].inside ? find(rays[i].pixel) : nullptr)
        value->radiance = gathered(i) - narrow(rays[i], tile, i);
  }

  /// Where the blur of a pixel is to be noted; null where nobody asked for it. No two threads may
  /// have the same pixel.
  PixelValue* find(std::size_t pixel);

  std::vector<PixelValue> take() { return std::move(values_); }

private:
  /// What the ray gathers in narrow kernels.
  Rgb narrow(const TileRays::PixelRay& ray, const BeamTile& tile, int index) const;

  const PhotonMap& map_;
  std::vector<PixelValue> values_;
};

} // namespace vdbeam
