#pragma once

#include "photonmap/photon_map.h"
#include "transport/photon_tracing.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace vdbeam {

/// The photons of a pass.
struct PhotonMaps {
  PhotonMap medium;
  PhotonMap caustics; ///< those of the medium that mirrors and glass brought (caustic_lights)
  PhotonMap surfaces;

  std::size_t bytes() const { return medium.bytes() + caustics.bytes() + surfaces.bytes(); }
  PhotonMaps copy() const { return {medium.copy(), caustics.copy(), surfaces.copy()}; }
};

/// Photon maps of passes, for later frames of a sequence in which nothing but the camera moves:
/// with correlated seeds their passes have the same photons. Maps are kept as they are before
/// anything that depends on the camera. All frames must have the same world.
class PhotonCache {
public:
  /// Keeps maps of up to `capacity` bytes in all.
  explicit PhotonCache(std::uint64_t capacity) : capacity_(capacity) {}

  /// The maps of these photons with kernels of these radii, from which those on surfaces follow;
  /// null where they are not there.
  std::shared_ptr<const PhotonMaps> find(const PhotonPassSettings& photons,
                                         const RadiusSettings& radii) const;
  /// Keeps a copy, unless there is no room for it. Maps of the same pass with other photons go.
  void keep(const PhotonPassSettings& photons, const RadiusSettings& radii, const PhotonMaps& maps);
  std::uint64_t bytes() const;

private:
  struct Entry {
    PhotonPassSettings photons;
    RadiusSettings radii;
    std::shared_ptr<const PhotonMaps> maps;
  };

  mutable std::mutex mutex_;
  std::uint64_t capacity_, bytes_ = 0;
  std::vector<Entry> entries_;
};

} // namespace vdbeam
