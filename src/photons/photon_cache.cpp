#include "photons/photon_cache.h"

#include <algorithm>

namespace vdbeam {

std::shared_ptr<const PhotonMaps> PhotonCache::find(const PhotonPassSettings& photons,
                                                    const RadiusSettings& radii) const {
  const std::scoped_lock lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.radii == radii && same_photons(entry.photons, photons);
  });
  return found == entries_.end() ? nullptr : found->maps;
}

void PhotonCache::keep(const PhotonPassSettings& photons, const RadiusSettings& radii,
                       const PhotonMaps& maps) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) {
    const bool outdated = entry.photons.key == photons.key;
    bytes_ -= outdated ? entry.maps->bytes() : 0;
    return outdated;
  });
  if (bytes_ + maps.bytes() > capacity_)
    return;
  entries_.push_back({photons, radii, std::make_shared<const PhotonMaps>(maps.copy())});
  entries_.back().photons.stop = nullptr; // may not live as long
  bytes_ += maps.bytes();
}

std::uint64_t PhotonCache::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

} // namespace vdbeam
