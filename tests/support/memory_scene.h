#pragma once

#include "transport/world.h"

#include <numbers>
#include <ostream>

namespace vdbeam {

/// How GoogleTest prints an estimator and a kind of light.
inline void PrintTo(const EstimatorType& type, std::ostream* out) {
  *out << type.name;
}
inline void PrintTo(const LightType& type, std::ostream* out) {
  *out << type.name;
}

} // namespace vdbeam

namespace vdbeam::test {

/// A field of cells.x * cells.y * cells.z cells of 8^3 whose lattice values, 0 to 8 n on each axis,
/// are `value(i, j, k)`. Nothing ramps: the field ends sharply on all six sides. Every cell is a
/// brick, also where it is uniform.
template <class Value>
DensityField closed_field(const Vec3<int>& cells, Value value) {
  constexpr int cell = cell_width, brick = brick_width;
  std::vector<std::int32_t> table;
  std::vector<float> bricks;
  for (int i = 0; i < cells.x; ++i)
    for (int j = 0; j < cells.y; ++j)
      for (int k = 0; k < cells.z; ++k) {
        table.push_back(static_cast<std::int32_t>(table.size()));
        for (int x = 0; x < brick; ++x)
          for (int y = 0; y < brick; ++y)
            for (int z = 0; z < brick; ++z)
              bricks.push_back(static_cast<float>(value(cell * i + x, cell * j + y, cell * k + z)));
      }
  return DensityField({0, 0, 0}, cells, std::move(table), std::move(bricks), {});
}

/// The same box, with one value everywhere and no bricks.
inline DensityField uniform_field(const Vec3<int>& cells, float value) {
  const std::size_t count = static_cast<std::size_t>(cells.x) * cells.y * cells.z;
  return DensityField({0, 0, 0}, cells, std::vector(count, DensityField::uniform_base), {},
                      {value});
}

/// A number in [0, 1) that is a pure function of a lattice point: white noise.
inline double lattice_noise(int i, int j, int k, std::uint64_t seed = 1) {
  Rng rng({seed, 0, 0}, RngStage::test,
          (static_cast<std::uint64_t>(i) << 40) + (static_cast<std::uint64_t>(j) << 20) +
              static_cast<std::uint64_t>(k));
  return rng.uniform();
}

/// Maps local [0, 8 cells] to the box from `lower` to `upper`.
inline Affine box_map(const Vec3<int>& cells, const Vec3d& lower, const Vec3d& upper) {
  Affine map;
  for (int a = 0; a < 3; ++a) {
    map.rows[static_cast<std::size_t>(a)] = Vec3d{};
    map.rows[static_cast<std::size_t>(a)][a] = (upper[a] - lower[a]) / (8 * cells[a]);
  }
  map.translation = lower;
  return map;
}

/// The turn about `axis` by `degrees` (Rodrigues).
inline Affine turn(const Vec3d& axis, double degrees) {
  const Vec3d n = normalize(axis);
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  Affine map;
  for (int a = 0; a < 3; ++a) {
    Vec3d unit{};
    unit[a] = 1;
    map.rows[static_cast<std::size_t>(a)] = unit * c + n * (n[a] * (1 - c)) - cross(n, unit) * s;
  }
  return map;
}

/// A scene whose volumes lie in memory, for `beam`. Unit-cube volumes by default; settings are
/// public.
struct MemoryScene {
  MemoryScene() { scene.render.estimator = EstimatorType::beam; }

  Scene scene;
  std::vector<DensityGrid> grids;
  std::vector<EmissionGrid> emissions;

  VolumeSettings& add(DensityField field, const Affine& index_to_world) {
    DensityGrid grid;
    grid.active_voxels = 1;
    grid.field = std::move(field);
    grid.index_to_world = index_to_world;
    grids.push_back(std::move(grid));
    return scene.volumes.emplace_back();
  }
  /// A homogeneous box of density 1.
  VolumeSettings& add_box(const Vec3d& lower, const Vec3d& upper) {
    return add(uniform_field({1, 1, 1}, 1), box_map({1, 1, 1}, lower, upper));
  }
  /// Lets the last volume glow, with the intensity `field`.
  EmissionSettings& glow(DensityField field, const Affine& index_to_world) {
    DensityGrid grid;
    grid.active_voxels = 1;
    grid.field = std::move(field);
    grid.index_to_world = index_to_world;
    EmissionSettings& settings = scene.volumes.back().emission;
    settings.intensity = "flame";
    emissions.resize(grids.size());
    emissions.back() = make_emission(settings, grid, {}, "memory", std::uint64_t(1) << 30);
    return settings;
  }
  LightSettings& add_light(LightType type) {
    LightSettings light;
    light.type = type;
    return scene.lights.emplace_back(light);
  }
  void look(const Vec3d& position, const Vec3d& look_at, double fov, int width, int height) {
    scene.camera.position = position;
    scene.camera.look_at = look_at;
    scene.camera.up = {0, 1, 0};
    if (length(cross(look_at - position, scene.camera.up)) < 1e-6 * length(look_at - position))
      scene.camera.up = {0, 0, 1};
    scene.camera.fov = fov;
    scene.image = {};
    scene.image.width = width;
    scene.image.height = height;
  }
  World world(WorldFacts* facts = nullptr) const {
    return build_world(scene, grids, emissions, facts);
  }
};

inline PhaseSettings henyey_greenstein(double g) {
  PhaseSettings phase;
  phase.type = PhaseType::henyey_greenstein;
  phase.g = g;
  return phase;
}

} // namespace vdbeam::test
