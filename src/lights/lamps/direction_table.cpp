#include "lights/lamps/direction_table.h"

#include <algorithm>

namespace vdbeam {

DirectionTable::DirectionTable(const Cone& cone,
                               const std::function<double(const Vec3d& direction)>& value)
    : cone_(cone), until_(static_cast<std::size_t>(rings) * sectors) {
  constexpr double even = 0.1;
  std::vector<double> masses(until_.size());
  double sum = 0;
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      double mean = 0;
      for (const double a : {0.25, 0.75})
        for (const double b : {0.25, 0.75})
          mean +=
              value(cone.sample(ring_begin(ring) + a * ring_share(ring), (sector + b) / sectors)) /
              4;
      sum += masses[static_cast<std::size_t>(ring * sectors + sector)] = mean * ring_share(ring);
    }
  double until = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double evenly = ring_share(static_cast<int>(i) / sectors) / sectors;
    until += sum > 0 ? (1 - even) * masses[i] / sum + even * evenly : evenly;
    until_[i] = until;
  }
  for (double& x : until_)
    x /= until;
}

DirectionTable::Sample DirectionTable::sample(double place, double v) const {
  const auto found = std::upper_bound(until_.begin(), until_.end() - 1, place);
  const auto cell = static_cast<int>(found - until_.begin());
  const double before = cell == 0 ? 0 : until_[static_cast<std::size_t>(cell) - 1];
  const double chance = *found - before;
  const double rest = std::clamp((place - before) / chance, 0.0, 1.0);
  const int ring = cell / sectors, sector = cell % sectors;
  return {cone_.sample(ring_begin(ring) + v * ring_share(ring), (sector + rest) / sectors),
          cone_.solid_angle() * ring_share(ring) / sectors / chance};
}

} // namespace vdbeam
