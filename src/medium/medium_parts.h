#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vdbeam {

/// Sorts volumes into parts of like extinction: a cloud and the thin fog around it. Photons of each
/// part are kept apart and count with its sigma_s alone. A photon of thin fog stands for far more
/// space than one of a cloud; with the cloud's sigma_s it would be a bright disc.
struct MediumParts {
  std::vector<std::uint8_t> of; ///< part of each volume
  std::size_t count = 1;

  MediumParts() = default;
  /// `peaks`: greatest extinction of each volume.
  explicit MediumParts(std::span<const float> peaks);

  std::size_t operator[](std::size_t volume) const { return of[volume]; }
  bool single() const { return count == 1; }
};

} // namespace vdbeam
