#include "estimators/view_thinning.h"

#include <cmath>

namespace vdbeam {

namespace {

/// Photons of less importance than 1 / most_factor are thinned even where there are too few.
constexpr double most_factor = 4;

double mean_share(const std::vector<float>& importance, double factor) {
  double sum = 0;
  for (const float value : importance)
    sum += std::min(1.0, factor * static_cast<double>(value));
  return sum / static_cast<double>(importance.size());
}

} // namespace

std::vector<float> view_importance_at(const World& world, const CellTables& importance,
                                      const PhotonList& photons) {
  std::vector<float> values(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
    for (std::size_t v = 0; v < importance.size(); ++v)
      values[i] =
          std::max(values[i], importance[v][world.medium.volumes[v].cell_at(photons.position[i])]);
  return values;
}

ViewThinning thin_by_view(const World& world, CellTables importance, const PhotonList& pilot,
                          double per_path, double wanted_per_path) {
  ViewThinning thinning;
  const std::vector<float> values = view_importance_at(world, importance, pilot);
  // No importance exceeds 1, so the factor is not under the share that is wanted.
  double low = std::min(most_factor, wanted_per_path / per_path), high = most_factor;
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
      value = std::min(1.0f, value * factor);
  return importance;
}

} // namespace vdbeam
