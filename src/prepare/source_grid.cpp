#include "prepare/source_grid.h"

#include "grids/combined_grid.h"
#include "grids/edited_field.h"
#include "grids/fog_grid.h"
#include "grids/refined_grid.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "volume/fog_shape.h"
#include "volume/noise.h"

#include <fmt/format.h>

#include <sstream>

namespace vdbeam {
namespace {

/// The names of a list like "a, b".
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    const auto first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
    if (first != std::string::npos)
      names.push_back(name.substr(first, last - first + 1));
  }
  return names;
}

DensityGrid masked_density(const VolumeSettings& volume, const std::optional<WantedBox>& wanted,
                           const StopToken& stop, DensityGrid grid, std::uint64_t& grids_read) {
  for (const std::string& name : names_in(volume.mask)) {
    const DensityGrid mask =
        read_density_grid(volume.file, name, {.stop = &stop}, Background::ignored, wanted);
    ++grids_read;
    GridEdits edits;
    edits.to_world = grid.index_to_world;
    edits.mask = &mask;
    edits.mask_to_world = mask.index_to_world;
    grid.field = edited_field(grid.field, edits, &stop);
  }
  return grid;
}

/// Whether the box holds the other one.
bool holds(const Boxd& box, const Boxd& other) {
  const Vec3d lower = min(box.lower, other.lower), upper = max(box.upper, other.upper);
  return lower == box.lower && upper == box.upper;
}

} // namespace

bool SourceGrid::has(const std::string& other, const std::optional<WantedBox>& part) const {
  return identity == other && (!wanted || (part && holds(wanted->world, part->world)));
}

std::string noise_text(const VolumeSettings& volume) {
  const NoiseSettings& noise = volume.noise;
  return noise.amplitude > 0 ? fmt::format("|noise {} {} {} {}", noise.amplitude, noise.size,
                                           noise.octaves, noise.seed)
                             : "";
}

std::string fog_text(const VolumeSettings& volume) {
  const FogSettings& fog = volume.fog;
  if (!fog.made())
    return "";
  const Boxd box = box_of(volume);
  return fmt::format("|fog {} {} {} {} {} {} {} {} {}", static_cast<int>(fog.shape),
                     fog.scale_height, fog.least_density, box.lower.x, box.lower.y, box.lower.z,
                     box.upper.x, box.upper.y, box.upper.z);
}

std::string density_source_identity(const VolumeSettings& volume) {
  return fog_text(volume) + fmt::format("density|{}|{}|{}|{}|{}{}", file_identity(volume.file),
                                        volume.density, volume.add, volume.mask,
                                        static_cast<int>(volume.interpolation), noise_text(volume));
}

DensityGrid read_density_source(const VolumeSettings& volume,
                                const std::optional<WantedBox>& wanted, const StopToken& stop,
                                std::uint64_t& grids_read) {
  if (volume.fog.made())
    return fog_grid(volume, {granted_memory(), &stop});
  std::vector<DensityGrid> grids;
  std::vector<std::string> names = names_in(volume.add);
  names.insert(names.begin(), volume.density);
  for (const std::string& name : names) {
    grids.push_back(
        read_density_grid(volume.file, name, {.stop = &stop}, Background::refused, wanted));
    ++grids_read;
    if (volume.interpolation == Interpolation::cubic)
      grids.back() = refined_grid(grids.back(), volume.file, {granted_memory(), &stop});
  }
  DensityGrid grid = grids.size() == 1
                         ? std::move(grids.front())
                         : sum_of_grids(std::move(grids), volume.file, {granted_memory(), &stop});
  grid = masked_density(volume, wanted, stop, std::move(grid), grids_read);
  return displaced_grid(grid, volume.noise, volume.file, {granted_memory(), &stop});
}

std::string emission_source_identity(const VolumeSettings& volume, const std::string& grid) {
  return fog_text(volume) + fmt::format("emission|{}|{}|{}{}", file_identity(volume.file), grid,
                                        static_cast<int>(volume.interpolation), noise_text(volume));
}

DensityGrid read_emission_source(const VolumeSettings& volume, const std::string& name,
                                 const std::optional<WantedBox>& wanted, const StopToken& stop,
                                 std::uint64_t& grids_read) {
  if (name.empty())
    return {};
  if (volume.fog.made()) // its density, by which it may glow too
    return fog_grid(volume, {granted_memory(), &stop});
  DensityGrid grid =
      read_density_grid(volume.file, name, {.stop = &stop}, Background::ignored, wanted);
  ++grids_read;
  if (volume.interpolation == Interpolation::cubic)
    grid = refined_grid(grid, volume.file, {granted_memory(), &stop});
  return displaced_grid(grid, volume.noise, volume.file, {granted_memory(), &stop});
}

} // namespace vdbeam
