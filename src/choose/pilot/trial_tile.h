#pragma once

#include "estimators/gather/regression.h"
#include "photons/photon_plan.h"
#include "rays/tile_rays.h"

#include <array>
#include <vector>

namespace vdbeam {

/// Upper left pixel of a tile.
struct TilePlace {
  int x0 = 0, y0 = 0;
};

/// The ray of a pixel, with its depth profile.
TileRays::PixelRay trial_ray(const EstimatorInput& input, const RngKey& key, std::size_t pixel);

/// Tiles spread over the picture, at which trials look; all of them where it is small.
std::vector<TilePlace> choose_trial_tiles(const Camera& camera);

/// Values of a tile's rays from the maps of two trials.
struct TrialTile {
  TilePlace place;
  /// By map, what the rays gather: one channel after another, in each the rays as in TileRays.
  std::vector<std::vector<float>> narrow, wide;
  // Per ray that meets the medium:
  std::vector<std::size_t> pixels; ///< of the picture
  std::vector<std::size_t> rays;   ///< of the tile
  // Per channel of each of them:
  std::vector<std::size_t> places; ///< in a map's picture
  std::vector<double> known;       ///< light that does not come from photons
  double brightness = 0;           ///< sum over these
  // Row by row, of all of the tile's pixels:
  std::array<float, TileRays::count> opacity{}, depth{}; ///< as in PassImage
  std::array<std::size_t, TileRays::count> ray_of{};     ///< the pixel's ray

  std::size_t channels() const { return pixels.empty() ? 1 : places.size() / pixels.size(); }
  SeenMedium seen() const;
};

/// `key`: of the rays' random numbers. `plan`: how the photons were chosen.
TrialTile view_trial_tile(const EstimatorInput& input, const PhotonPlan& plan,
                          const TilePlace& place, const std::vector<PhotonMap>& narrow,
                          const std::vector<PhotonMap>& wide, const RngKey& key);

/// Mean and sum of squared deviations of one value over the maps.
struct Spread {
  double mean = 0, squares = 0;

  Spread(const std::vector<std::vector<float>>& pictures, std::size_t place);
};

/// Running sums of one value measured on independent maps.
struct PairedSums {
  double sum = 0, squares = 0;
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  /// The square of what the maps agree on: the mean over pairs of different maps, in which noise is
  /// no part.
  double common_square() const { return (sum * sum - squares) / (count * (count - 1.0)); }
};

/// Weight of a pixel's squared error, as in MRSE.
inline double trial_weight(double brightness, double dark) {
  const double offset_brightness = std::max(0.0, brightness) + dark;
  return 1 / (offset_brightness * offset_brightness);
}

} // namespace vdbeam
