#include "lights/volume_light.h"

#include "math/sampling.h"

#include <tbb/parallel_for.h>

namespace vdbeam {

namespace {

/// Sum over the corners of a cube: 8 times the mean of the trilinear field in it.
Rgb corner_sum(const Rgb* p) {
  return p[0] + p[1] + p[brick_width] + p[brick_width + 1] + p[brick_width * brick_width] +
         p[brick_width * brick_width + 1] + p[brick_width * brick_width + brick_width] +
         p[brick_width * brick_width + brick_width + 1];
}

} // namespace

VolumeLight::VolumeLight(const Emitter& emitter)
    : emitter_(emitter), cube_volume_(std::abs(emitter.to_render.determinant())) {
  const EmissionField& field = *emitter_.field;
  brick_sums_.resize(field.brick_count() * cube_count);
  tbb::parallel_for(std::size_t{0}, field.brick_count(),
                    [this](std::size_t brick) { sum_brick(static_cast<std::int32_t>(brick)); });
  const Vec3<int>& n = field.cell_counts();
  double end = 0;
  Vec3d total;
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const std::int32_t entry = field.cell(i, j, k);
        if (entry == DensityField::empty_cell)
          continue;
        end += cell_sum(entry);
        cells_.push_back({{i, j, k}, end});
        if (entry < 0) {
          total += Vec3d(field.uniform_value(entry)) * static_cast<double>(cube_count);
          continue;
        }
        Vec3d sum;
        for (int c = 0; c < cube_count; ++c)
          sum +=
              Vec3d(corner_sum(field.brick(entry) +
                               ((c >> 6) * brick_width + ((c >> 3) & 7)) * brick_width + (c & 7)));
        total += sum / 8.0;
      }
  power_ = Rgb(total * Vec3d(emitter_.strength) * (4 * static_cast<double>(pi) * cube_volume_));
}

void VolumeLight::sum_brick(std::int32_t brick) {
  const Rgb* values = emitter_.field->brick(brick);
  float* sums = brick_sums_.data() + static_cast<std::size_t>(brick) * cube_count;
  double sum = 0;
  for (int c = 0; c < cube_count; ++c) {
    const Rgb corners =
        corner_sum(values + ((c >> 6) * brick_width + ((c >> 3) & 7)) * brick_width + (c & 7));
    sum += static_cast<double>(mean_component(corners * emitter_.strength)) / 8;
    sums[c] = static_cast<float>(sum);
  }
}

double VolumeLight::cell_sum(std::int32_t entry) const {
  if (entry >= 0)
    return static_cast<double>(brick_sums_[(static_cast<std::size_t>(entry) + 1) * cube_count - 1]);
  const Rgb value = emitter_.field->uniform_value(entry) * emitter_.strength;
  return static_cast<double>(mean_component(value)) * cube_count;
}

/// The cube of a brick at `place` of its running sum, and its share of that.
int VolumeLight::find_cube(std::int32_t brick, float place, double& share) const {
  const float* sums = brick_sums_.data() + static_cast<std::size_t>(brick) * cube_count;
  // Rounding must not lead to a cube without light.
  const float inside = std::min(place, std::nextafter(sums[cube_count - 1], 0.0f));
  const auto cube = static_cast<int>(std::upper_bound(sums, sums + cube_count, inside) - sums);
  share = static_cast<double>(sums[cube]) - (cube > 0 ? static_cast<double>(sums[cube - 1]) : 0);
  return cube;
}

EmittedPhoton VolumeLight::emit(double place, Rng& rng) const {
  const float u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
  const float u_direction = rng.uniform(), v_direction = rng.uniform();
  if (cells_.empty() || !(cells_.back().end > 0))
    return {};
  const double total = cells_.back().end;
  const auto found =
      std::upper_bound(cells_.begin(), cells_.end() - 1, place * total,
                       [](double value, const Cell& cell) { return value < cell.end; });
  const std::int32_t entry = emitter_.field->cell(found->place.x, found->place.y, found->place.z);
  const double begin = found == cells_.begin() ? 0 : (found - 1)->end;
  // A cube of a brick, or a whole uniform cell; the point is uniform inside it.
  Vec3f corner, local;
  double share = cell_sum(entry), size = cube_count;
  if (entry >= 0) {
    const int cube = find_cube(entry, static_cast<float>(place * total - begin), share);
    corner = Vec3f(Vec3<int>{cube >> 6, (cube >> 3) & 7, cube & 7});
    local = corner + Vec3f(u, v, w);
    size = 1;
  } else {
    local = Vec3f(u, v, w) * static_cast<float>(cubes);
  }
  if (!(share > 0))
    return {};
  const Rgb value = emitter_.field->sample_cell(entry, local) * emitter_.strength;
  const double weight = 4 * static_cast<double>(pi) * cube_volume_ * size * total / share;
  const Vec3d point = Vec3d(found->place) * static_cast<double>(cubes) + Vec3d(local);
  return {{Vec3f(emitter_.to_render.point(point)), sample_sphere(u_direction, v_direction)},
          Rgb(Vec3d(value) * weight)};
}

} // namespace vdbeam
