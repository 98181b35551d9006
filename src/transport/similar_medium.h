#pragma once

#include "transport/world.h"

#include <map>
#include <memory>

namespace vdbeam {

/// The medium whose forward peak of scattering is taken out (similarity; Wiscombe 1977, eq. 14-16):
/// light that a droplet scatters almost straight ahead is treated as not scattered,
///   sigma_t' = sigma_t (1 - albedo f),  albedo' = albedo (1 - f) / (1 - albedo f),  p -> p',
/// with f and p' of truncate_peak. Absorption and the transport cross-section stay as they are.
/// `medium.peak` of the result says what was taken out. Null where no phase function has a peak.
std::shared_ptr<const Medium> similar_medium(const Medium& medium, int order);

/// How much bias the truncation of such a medium makes, in arbitrary units. That
/// the peak has no width is wrong by (chi_M - chi_l) in the moments l > M of the phase function;
/// the bias goes about as the square of this for l = M + 2 (measured, research-log/decisions.md). 0
/// where nothing was taken out.
float truncation(const Medium& medium);

/// The worlds in which the photons of passes live: with the peak taken out by truncations of
/// several orders, or the scene's own.
class PassWorlds {
public:
  /// `world` must outlive this.
  explicit PassWorlds(const World& world) : world_(world) {}

  /// The world whose phase functions are truncated at this order; the scene's own for 0, and where
  /// no phase function has a peak. Lives as long as this.
  const World& of(int order);

private:
  const World& world_;
  std::map<int, std::unique_ptr<World>> similar_; ///< by order; null where no peak is taken out
};

/// How deep the medium is for light that crosses it: the mean optical depth of straight lines in
/// all directions, weighted by the optical depth itself, so that thin skins about dense cores do
/// not count. Lines count as no deeper than opaque_optical_depth.
double typical_depth(const Medium& medium);

} // namespace vdbeam
