#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// Procedural volumes for tests and experiments: simple media whose answers are known, and files
/// with every property that has ever gone wrong in a reader.

struct VolumeKind {
  std::string name;
  std::string description;
};

struct VolumeOptions {
  int size = 64;          ///< voxels across
  double density = 1;     ///< of the medium where it is constant, its largest value elsewhere
  double extent = 2;      ///< world units across; the volume is centred at 0 unless it is "far"
  std::uint64_t seed = 1; ///< of the kinds with noise and of clouds
  std::string name = "density"; ///< of the grid
};

/// Every kind that `write_volume` knows, in the order to show them.
std::vector<VolumeKind> volume_kinds();

/// Writes a volume of one kind to a VDB file. Throws InputError on an unknown kind or a bad option,
/// and std::exception where the file cannot be written.
void write_volume(const std::string& kind, const std::string& path,
                  const VolumeOptions& options = {});

} // namespace vdbeam
