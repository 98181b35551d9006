#include "medium/emission_directions.h"

#include "medium/grid_traversal.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Mean of what a cell sends out, over the field's points in it and over the channels.
double brightness(const Emitter& emitter, std::int32_t entry) {
  const EmissionField& field = *emitter.field;
  if (entry < 0)
    return static_cast<double>(mean_component(field.uniform_value(entry) * emitter.strength));
  const Rgb* values = field.brick(entry);
  double sum = 0;
  for (int i = 0; i < DensityField::brick_size; ++i)
    sum += static_cast<double>(mean_component(values[i] * emitter.strength));
  return sum / DensityField::brick_size;
}

} // namespace

EmissionDirections::EmissionDirections(const std::vector<Emitter>& emitters) {
  for (const Emitter& emitter : emitters) {
    const Vec3<int>& n = emitter.field->cell_counts();
    grids_.push_back({emitter, std::vector<float>(static_cast<std::size_t>(n.x) * n.y * n.z)});
    add_cells(grids_.size() - 1);
  }
  const double total = cells_.empty() ? 0 : cells_.back().end;
  if (!(total > 0))
    cells_.clear();
  for (Cell& cell : cells_)
    cell.end /= total;
  for (Grid& grid : grids_)
    for (float& density : grid.density)
      density = total > 0 ? static_cast<float>(static_cast<double>(density) / total) : 0;
}

/// Adds the cells of a grid that glow, their densities still without the common divisor.
void EmissionDirections::add_cells(std::size_t grid) {
  const Emitter& emitter = grids_[grid].emitter;
  const EmissionField& field = *emitter.field;
  const double volume =
      cell_width * cell_width * cell_width * std::abs(emitter.to_render.determinant());
  const Vec3<int>& n = field.cell_counts();
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const std::int32_t entry = field.cell(i, j, k);
        const double bright = entry == DensityField::empty_cell ? 0 : brightness(emitter, entry);
        if (!(bright > 0))
          continue;
        grids_[grid].density[field.cell_offset(i, j, k)] = static_cast<float>(bright);
        const double before = cells_.empty() ? 0 : cells_.back().end;
        cells_.push_back({grid, {i, j, k}, before + bright * volume});
      }
}

std::optional<EmissionDirections::Sample> EmissionDirections::sample(const Vec3f& point,
                                                                     Rng& rng) const {
  const double place = static_cast<double>(rng.uniform());
  const float u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
  if (cells_.empty())
    return std::nullopt;
  const auto found = std::upper_bound(cells_.begin(), cells_.end() - 1, place,
                                      [](double x, const Cell& cell) { return x < cell.end; });
  const Vec3d local =
      (Vec3d(found->place) + Vec3d(Vec3f(u, v, w))) * static_cast<double>(cell_width);
  const Vec3d way = grids_[found->grid].emitter.to_render.point(local) - Vec3d(point);
  const double distance = length(way);
  if (!(distance > 0))
    return std::nullopt;
  const Vec3f wi(way / distance);
  const float density = pdf(point, wi);
  if (!(density > 0))
    return std::nullopt;
  return Sample{wi, density};
}

float EmissionDirections::pdf(const Vec3f& point, const Vec3f& wi) const {
  float sum = 0;
  for (const Grid& grid : grids_) {
    const EmissionField& field = *grid.emitter.field;
    constexpr float inverse = 1.0f / cell_width;
    GridTraversal cells(grid.emitter.local_point(point) * inverse,
                        grid.emitter.local_vector(wi) * inverse, field.cell_counts(), 0, infinity);
    for (; !cells.done(); cells.advance()) {
      const Vec3<int>& c = cells.cell();
      const float a = cells.t(), b = cells.t_exit();
      // (b^3 - a^3) / 3 without the difference of cubes
      sum += grid.density[field.cell_offset(c.x, c.y, c.z)] * (b - a) * (a * a + a * b + b * b) *
             (1.0f / 3);
    }
  }
  return sum;
}

} // namespace vdbeam
