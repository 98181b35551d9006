#pragma once

#include "camera/camera.h"
#include "math/stop_token.h"
#include "medium/path_guide.h"
#include "photonmap/photon.h"
#include "transport/world.h"

#include <memory>

namespace vdbeam {

/// Settings of a photon pass.
struct PhotonPassSettings {
  std::uint64_t paths = 0; ///< light paths emitted
  PhotonStore store = PhotonStore::fluence;
  /// With which probability a storable collision is stored, its power divided by it; 0: none is.
  float store_probability = 1;
  /// Where given, in place of `store_probability`: the probability by cell, each > 0; more than 1
  /// counts as 1.
  std::shared_ptr<const CellTables> store_probability_by_cell;
  /// Where given, the probability by cell is multiplied by towards_camera().
  std::optional<Camera> camera;
  /// Order of the truncation that made the world's medium of the scene's; 0: none.
  int truncation_order = 0;
  /// Per light: true where its first flight is left to shadow rays and not stored.
  std::vector<bool> skip_first_flight;
  std::optional<int> max_bounces;
  /// Per light: photons whose first event is a mirror or smooth glass or, of near lights, the
  /// medium are stored where they arrive at other surfaces, after any further events. Empty: no
  /// photons are stored on surfaces.
  std::vector<bool> surface_photon_lights;
  /// Per light: photons that mirrors and smooth glass alone have sent on before they reach the
  /// medium are stored once more in a list of their own. Empty: none are.
  std::vector<bool> caustic_lights;
  bool directions = true; ///< false: no phase function needs them
  Rgb albedo{1, 1, 1};    ///< fluence storage: stored powers are multiplied by it
  /// Where given: what decides where light paths begin, end and split.
  std::shared_ptr<const PathGuide> guide;
  bool path_numbers = false; ///< photons carry the number of their path
  RngKey key;
  /// Stops tracing soon; the result is then incomplete.
  const StopToken* stop = nullptr;
};

/// Shares of the lights in the photons where no guide is, up to a factor: by their power. Where the
/// medium has nests, half of a share is that of the power into the smallest, which a lamp beside a
/// cloud may light as much as the sun, although the sun lights all of the fog around.
std::vector<double> shares_by_power(const LightSet& lights);

/// First path number of each light, and the number after the last: lights share the paths by power,
/// or as the guide has it.
std::vector<std::uint64_t> share_paths(const LightSet& lights, std::uint64_t paths,
                                       const PathGuide* guide);

/// True where trace_photons gives the same photons in the same world. `stop` is not compared: the
/// flag it points to may be gone.
bool same_photons(const PhotonPassSettings& a, const PhotonPassSettings& b);

struct TracedPhotons {
  PhotonList photons;         ///< power divided by the number of paths already
  PhotonList caustics;        ///< those of `caustic_lights`, which are among `photons`
  PhotonList surface_photons; ///< of `surface_photon_lights`; power is flux [W]; with directions
  double mean_collisions = 0; ///< storable collisions per path, before thinning
};

/// Shoots photons from all lights and stores them; parallel, and the same for any number of
/// threads.
///
/// Fluence storage: at every tentative collision of delta tracking, null or real, flux / majorant:
/// an unbiased sample of the fluence, whose weight is bounded by the local majorant
/// (docs/theory/beam.md). Scatter storage: at every real collision the scattered flux (Jensen and
/// Christensen 1998).
///
/// Where `stop` asked to end meanwhile, there are no photons.
TracedPhotons trace_photons(const World& world, const PhotonPassSettings& settings);

} // namespace vdbeam
