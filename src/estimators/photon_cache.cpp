#include "estimators/photon_cache.h"

#include <algorithm>

namespace vdbeam {

std::shared_ptr<const PhotonMap> PhotonCache::find(const PhotonPassSettings& settings,
                                                   double neighbours) const {
  const std::scoped_lock lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.neighbours == neighbours && same_photons(entry.settings, settings);
  });
  return found == entries_.end() ? nullptr : found->map;
}

void PhotonCache::keep(const PhotonPassSettings& settings, double neighbours,
                       const PhotonMap& map) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) {
    const bool outdated = entry.settings.key == settings.key;
    bytes_ -= outdated ? entry.map->bytes() : 0;
    return outdated;
  });
  if (bytes_ + map.bytes() > capacity_)
    return;
  entries_.push_back({settings, neighbours, std::make_shared<const PhotonMap>(map.copy())});
  entries_.back().settings.stop = nullptr; // may not live as long
  bytes_ += map.bytes();
}

std::uint64_t PhotonCache::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

} // namespace vdbeam
