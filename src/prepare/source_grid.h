#pragma once

#include "vdb/vdb_reader.h"
#include "vdbeam/scene.h"

#include <optional>
#include <string>

namespace vdbeam {

/// A grid of a volume as its file has it: with what is added to it and its masks, interpolated and
/// displaced by noise, but neither moved nor edited, which each moment of a shutter does in a way
/// of its own.
struct SourceGrid {
  std::string identity;            ///< all that it was made from
  std::optional<WantedBox> wanted; ///< the part of it that is there; none: all
  DensityGrid grid;

  /// Whether it is the grid of that identity, with all that is wanted.
  bool has(const std::string& other, const std::optional<WantedBox>& part) const;
};

std::string density_source_identity(const VolumeSettings& volume);
/// Reads the source of a volume's density; adds to `grids_read`. Throws Stopped.
DensityGrid read_density_source(const VolumeSettings& volume,
                                const std::optional<WantedBox>& wanted, const StopToken& stop,
                                std::uint64_t& grids_read);

/// The same for a grid of its emission; empty if it has no name.
std::string emission_source_identity(const VolumeSettings& volume, const std::string& grid);
DensityGrid read_emission_source(const VolumeSettings& volume, const std::string& grid,
                                 const std::optional<WantedBox>& wanted, const StopToken& stop,
                                 std::uint64_t& grids_read);

/// What decides the density of a volume without a file, as text; "" for others.
std::string fog_text(const VolumeSettings& volume);

/// The settings of a volume's noise, as text.
std::string noise_text(const VolumeSettings& volume);

} // namespace vdbeam
