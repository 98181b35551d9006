#include "volume/density_layers.h"

#include "volume/density_field.h"

#include <cmath>

namespace vdbeam {

namespace {

bool is_layered(const float* brick) {
  for (int x = 0; x < brick_width; ++x)
    for (int y = 0; y < brick_width; ++y)
      for (int z = 0; z < brick_width; ++z)
        if (brick[(x * brick_width + y) * brick_width + z] != brick[y * brick_width])
          return false;
  return true;
}

/// All cells of each height have the same entry in the field's table.
bool has_like_cells(const DensityField& field) {
  const Vec3<int>& counts = field.cell_counts();
  for (int y = 0; y < counts.y; ++y)
    for (int x = 0; x < counts.x; ++x)
      for (int z = 0; z < counts.z; ++z)
        if (field.cell(x, y, z) != field.cell(0, y, 0))
          return false;
  return true;
}

} // namespace

std::shared_ptr<const DensityLayers> DensityLayers::find(const DensityField& field) {
  if (field.empty() || !has_like_cells(field))
    return nullptr;
  auto layers = std::make_shared<DensityLayers>();
  for (int cell = 0; cell < field.cell_counts().y; ++cell) {
    const std::int32_t entry = field.cell(0, cell, 0);
    const float* brick = entry >= 0 ? field.brick(entry) : nullptr;
    if (brick && !is_layered(brick))
      return nullptr;
    const float uniform =
        entry >= 0 || entry == DensityField::empty_cell ? 0.0f : field.uniform_value(entry);
    const auto value = [&](int y) { return double{brick ? brick[y * brick_width] : uniform}; };
    if (cell == 0) {
      layers->lower_.push_back(0);
      layers->density_.push_back(value(0));
      layers->integral_.push_back(0);
    }
    if (layers->density_.back() != value(0)) // a face of the field in between
      return nullptr;
    for (int y = 1; y <= cell_width; ++y) {
      layers->layer_of_voxel_.push_back(layers->count());
      if (brick || y == cell_width)
        layers->add(static_cast<float>(cell * cell_width + y), value(y));
    }
  }
  return layers;
}

void DensityLayers::add(float upper, double density) {
  const double height = double{upper} - lower_.back();
  integral_.push_back(integral_.back() + 0.5 * height * (density_.back() + density));
  lower_.push_back(upper);
  density_.push_back(density);
}

double DensityLayers::below(double y) const {
  const std::size_t layer = layer_at(y);
  const double height = y - lower_[layer];
  return integral_[layer] + 0.5 * height * (density_[layer] + density(layer, y));
}

double DensityLayers::mean_density(double y_a, double y_b) const {
  // Under this difference of heights [voxels] the quotient loses digits; the line bends by less.
  constexpr double least_difference = 1e-3;
  const std::size_t layer_a = layer_at(y_a), layer_b = layer_at(y_b);
  if (layer_a == layer_b || std::abs(y_b - y_a) < least_difference)
    return 0.5 * (density(layer_a, y_a) + density(layer_b, y_b));
  return (below(y_b) - below(y_a)) / (y_b - y_a);
}

} // namespace vdbeam
