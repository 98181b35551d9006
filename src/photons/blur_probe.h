#pragma once

#include "photons/photon_pass.h"
#include "rays/tile_rays.h"

#include <cmath>
#include <utility>

namespace vdbeam {

/// Estimates the kernels' bias: at some pixels of a pass photons are gathered once more, in
/// kernels of another width. The differences have little noise, since both see the same photons,
/// and their mean over the passes tends to a known part of the kernels' bias
/// (docs/theory/error-estimate.md, "Errors").
class BlurProbe {
public:
  /// Width of those kernels over that of the pass's. Along rays narrower ones are more sensitive at
  /// edges; where walks gather, whose kernels blur little, wider ones have less noise.
  static constexpr float width_along_rays = 0.5f, width_of_walks = 1.4f;
  /// The bias over what kernels of the pass gather less what those of another width do: bias goes
  /// as the width to the power of 1.5; of 2 where kernels are small against all that they blur,
  /// less where they are as wide (measured, research-log/decisions.md).
  static float bias_over_difference(float width) { return 1 / (1 - std::pow(width, 1.5f)); }

  /// Probes the input's blur pixels. `photons` must outlive this.
  BlurProbe(const EstimatorInput& input, const PhotonPass& photons);

  /// Fills in the pixels of a tile that has been gathered; tiles may come in any order and from any
  /// thread. gathered(i): what ray i of the tile gathered from the photons.
  template <class Gathered>
  void probe(const TileRays& rays, BeamTile& tile, const Gathered& gathered) {
    for (int i = 0; i < TileRays::count && !values_.empty(); ++i)
      if (PixelValue* value = rays[i].inside ? find(rays[i].pixel) : nullptr)
        value->radiance =
            (gathered(i) - compared(rays[i], tile, i)) * bias_over_difference(width_along_rays);
  }

  /// Where the blur of a pixel is to be noted; null where nobody asked for it. No two threads may
  /// have the same pixel.
  PixelValue* find(std::size_t pixel);

  std::vector<PixelValue> take() { return std::move(values_); }

private:
  /// Light gathered by the ray in kernels of the other width.
  Rgb compared(const TileRays::PixelRay& ray, BeamTile& tile, int index) const;

  const PhotonMap& map_;
  std::vector<PixelValue> values_;
};

} // namespace vdbeam
