#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace vdbeam {

class DensityField;

/// A density that changes along local y alone, such as that of a fog: linear between planes. A ray
/// crosses far fewer planes than cells then, and its optical depth has a closed form.
class DensityLayers {
public:
  /// The layers of a field; null where it changes along x or z, too.
  static std::shared_ptr<const DensityLayers> find(const DensityField& field);

  std::size_t count() const { return lower_.size() - 1; }
  float lower(std::size_t layer) const { return lower_[layer]; }
  float upper(std::size_t layer) const { return lower_[layer + 1]; }
  /// The layer of height y; the nearest one for heights outside.
  std::size_t layer_at(double y) const {
    const auto voxel = static_cast<std::size_t>(std::max(y, 0.0));
    return layer_of_voxel_[std::min(voxel, layer_of_voxel_.size() - 1)];
  }
  /// The density within a layer.
  double density(std::size_t layer, double y) const {
    const double share = (y - lower_[layer]) / (lower_[layer + 1] - lower_[layer]);
    return density_[layer] + share * (density_[layer + 1] - density_[layer]);
  }
  bool is_empty(std::size_t layer) const { return density_[layer] + density_[layer + 1] == 0; }
  /// Mean density on a straight line between two heights inside the field.
  double mean_density(double y_a, double y_b) const;

private:
  void add(float upper, double density);
  /// Integral of the density from height 0.
  double below(double y) const;

  // At the planes between layers:
  std::vector<float> lower_;     ///< heights
  std::vector<double> density_;  ///< values
  std::vector<double> integral_; ///< of the density, from the first plane
  std::vector<std::size_t> layer_of_voxel_;
};

} // namespace vdbeam
