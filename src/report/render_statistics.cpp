#include "vdbeam/render_statistics.h"

#include <algorithm>
#include <iterator>

namespace vdbeam {
namespace {

using S = RenderStatistics;

constexpr double S::*sums[] = {&S::read,    &S::prepare,       &S::pilot,      &S::build,
                               &S::trace,   &S::order,         &S::radii,      &S::query,
                               &S::profile, &S::direct,        &S::path,       &S::bias,
                               &S::write,   &S::clamp_removed, &S::clamp_total};
constexpr std::uint64_t S::*counts[] = {
    &S::light_paths,      &S::photons_stored,  &S::contributions,   &S::camera_rays,
    &S::lookups,          &S::depth_profiles,  &S::shadow_rays,     &S::emission_rays,
    &S::camera_walks,     &S::neighbourhoods,  &S::bias_rays,       &S::directions,
    &S::maps_reused,      &S::pilot_paths,     &S::importance_rays, &S::clamped_pixels,
    &S::light_collisions, &S::walk_collisions, &S::meshes_read,     &S::textures_read,
    &S::trees_built,      &S::grids_read,      &S::gather_walks,    &S::walk_shadow_rays};

// Whoever adds a field decides here how it is added up.
static_assert(sizeof(S) == sizeof(double) * std::size(sums) +
                               sizeof(std::uint64_t) * std::size(counts) + sizeof(S::neighbours) +
                               sizeof(S::peak_memory) + sizeof(S::bytes_per_photon));

} // namespace

RenderStatistics& RenderStatistics::operator+=(const RenderStatistics& other) {
  for (double S::*sum : sums)
    this->*sum += other.*sum;
  for (std::uint64_t S::*count : counts)
    this->*count += other.*count;
  neighbours = std::max(neighbours, other.neighbours);
  peak_memory = std::max(peak_memory, other.peak_memory);
  bytes_per_photon = std::max(bytes_per_photon, other.bytes_per_photon);
  return *this;
}

} // namespace vdbeam
