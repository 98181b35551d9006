#include "photons/view_thinning.h"

#include "camera/towards_camera.h"
#include "tuning/constants.h"

#include <cmath>

namespace vdbeam {

namespace {

/// Calls visit(v) for the volumes to whose part of the medium photon i belongs.
template <class Visit>
void for_each_of_its_part(const Medium& medium, const PhotonList& photons, std::size_t i,
                          const Visit& visit) {
  const std::size_t part = photons.part.empty() ? 0 : photons.part[i];
  medium.for_each_at(photons.position[i], [&](std::size_t v) {
    if (medium.parts[v] == part)
      visit(v);
  });
}

/// Importance of a photon for the image: the importance of its place times what is scattered
/// towards the camera, of the volume for which that is most.
std::vector<float> worth_of(const World& world, const Camera& camera, const CellTables& importance,
                            const PhotonList& photons) {
  if (photons.direction.empty() || !sees_directly(world))
    return view_importance_at(world, importance, photons);
  std::vector<float> values(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
    for_each_of_its_part(world.medium, photons, i, [&](std::size_t v) {
      const Volume& volume = world.medium.volumes[v];
      const Vec3f& position = photons.position[i];
      values[i] = std::max(values[i], importance[v][volume.cell_at(position)] *
                                          towards_camera(camera, world.medium, volume, position,
                                                         photons.direction[i]));
    });
  return values;
}

double mean_share(const std::vector<float>& worth, double factor) {
  double sum = 0;
  for (const float value : worth)
    sum += std::min(1.0, factor * static_cast<double>(value));
  return sum / static_cast<double>(worth.size());
}

} // namespace

std::vector<float> view_importance_at(const World& world, const CellTables& importance,
                                      const PhotonList& photons) {
  std::vector<float> values(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
    for_each_of_its_part(world.medium, photons, i, [&](std::size_t v) {
      values[i] =
          std::max(values[i], importance[v][world.medium.volumes[v].cell_at(photons.position[i])]);
    });
  return values;
}

ViewThinning thin_by_view(const World& world, const Camera& camera, CellTables importance,
                          const PhotonList& pilot, double per_path, double wanted_per_path) {
  ViewThinning thinning;
  const std::vector<float> values = worth_of(world, camera, importance, pilot);
  // With the lower factor no probability exceeds the share that is wanted, nor does their mean.
  const double most =
      std::max(1.0, static_cast<double>(*std::max_element(values.begin(), values.end())));
  double low = std::min(tuning::most_view_factor, wanted_per_path / per_path / most),
         high = tuning::most_view_factor;
  for (int step = 0; step < 40; ++step) {
    const double middle = std::sqrt(low * high);
    (mean_share(values, middle) * per_path < wanted_per_path ? low : high) = middle;
  }
  thinning.stored_per_path = mean_share(values, high) * per_path;
  thinning.factor = static_cast<float>(high);
  thinning.store_probability = store_by_view(std::move(importance), thinning.factor);
  return thinning;
}

CellTables store_by_view(CellTables importance, float factor) {
  for (std::vector<float>& table : importance)
    for (float& value : table)
      value *= factor;
  return importance;
}

} // namespace vdbeam
