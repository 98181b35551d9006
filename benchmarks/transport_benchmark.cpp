#include "medium/delta_tracking.h"
#include "medium/depth_profile.h"
#include "medium/scattering.h"
#include "support/next_scattering.h"

#include <benchmark/benchmark.h>

namespace vdbeam {
namespace {

/// A noisy ball in a grid of `cells`^3 cells, lattice spacing 1 / (8 cells) in render space.
Medium noisy_ball(int cells, float optical_depth, float g) {
  const int n = 8 * cells;
  const auto density = [n](int x, int y, int z) {
    const float scale = 2.0f / static_cast<float>(n);
    const Vec3f p = Vec3f(Vec3<int>{x, y, z}) * scale - Vec3f(1);
    if (dot(p, p) > 1 || x >= n || y >= n || z >= n)
      return 0.0f;
    const std::uint64_t hash = mix64(static_cast<std::uint64_t>((x * 4096 + y) * 4096 + z));
    return 0.5f + static_cast<float>(hash >> 40) * 0x1p-24f;
  };
  std::vector<std::int32_t> index;
  std::vector<float> bricks;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        index.push_back(static_cast<std::int32_t>(index.size()));
        for (int x = 0; x < 9; ++x)
          for (int y = 0; y < 9; ++y)
            for (int z = 0; z < 9; ++z)
              bricks.push_back(density(8 * i + x, 8 * j + y, 8 * k + z));
      }
  Volume volume;
  volume.field =
      DensityField({0, 0, 0}, {cells, cells, cells}, std::move(index), std::move(bricks), {});
  volume.majorants = MajorantGrid(volume.field);
  const float lattice = static_cast<float>(n);
  volume.to_local.rows = {Vec3f{lattice, 0, 0}, Vec3f{0, lattice, 0}, Vec3f{0, 0, lattice}};
  volume.to_local.translation = Vec3f(0.5f * lattice);
  volume.extinction = optical_depth;
  volume.albedo = Rgb(0.99f);
  volume.voxel_size = 1 / lattice;
  Medium medium;
  PhaseSettings phase;
  phase.type = PhaseType::henyey_greenstein;
  phase.g = g;
  medium.phases.emplace_back(phase);
  medium.bounds = {Vec3f(-0.5f), Vec3f(0.5f)};
  medium.volumes.push_back(std::move(volume));
  return medium;
}

const Medium& sample_medium() {
  static const Medium medium = noisy_ball(32, 50, 0.8f);
  return medium;
}

Ray ray_through_ball(Rng& rng) {
  const float x = 0.5f * (rng.uniform() - 0.5f), y = 0.5f * (rng.uniform() - 0.5f);
  return {{x, y, -0.6f}, {0, 0, 1}};
}

/// Trilinear look-ups, marching `state.range(0)` voxels at a step.
void look_ups(benchmark::State& state) {
  const Volume& volume = sample_medium().volumes[0];
  const float step = static_cast<float>(state.range(0));
  Rng rng({}, RngStage::test, 1);
  std::int64_t count = 0;
  for (auto _ : state) {
    Vec3f p{64 + 128 * rng.uniform(), 64 + 128 * rng.uniform(), 8};
    float sum = 0;
    for (; p.z < 248; p.z += step, p.x += 0.1f * step, ++count)
      sum += volume.field.sample(p);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(count);
}
BENCHMARK(look_ups)->Arg(1)->Arg(4);

/// Photon-like walks: real collisions per second.
void delta_tracking(benchmark::State& state) {
  const Medium& medium = sample_medium();
  const PhaseFunction& phase = medium.phases[0];
  std::uint64_t path = 0;
  std::int64_t collisions = 0;
  for (auto _ : state) {
    Rng rng({}, RngStage::test, path++);
    Ray ray = ray_through_ball(rng);
    Rgb weight(1);
    while (true) {
      const Collision hit = test::next_scattering(medium, ray, weight, rng);
      if (hit.volume == nullptr)
        break;
      ++collisions;
      if (!absorption_roulette(hit.volume->albedo, weight, rng))
        break;
      const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
      ray = {ray.at(hit.t), phase.sample(ray.direction, u_lobe, u, v)};
    }
  }
  state.SetItemsProcessed(collisions);
}
BENCHMARK(delta_tracking);

/// Exact optical depth: lattice cubes per second.
void depth_profiles(benchmark::State& state) {
  const Medium& medium = sample_medium();
  DepthProfile profile;
  Rng rng({}, RngStage::test, 2);
  std::int64_t pieces = 0;
  for (auto _ : state) {
    profile.build(medium, {ray_through_ball(rng), 0, 2}, 1e-30f);
    pieces += static_cast<std::int64_t>(profile.knots());
  }
  state.SetItemsProcessed(pieces);
}
BENCHMARK(depth_profiles);

/// Majorants of the field's cells.
void majorant_grid(benchmark::State& state) {
  const DensityField& field = sample_medium().volumes[0].field;
  for (auto _ : state)
    benchmark::DoNotOptimize(MajorantGrid(field));
}
BENCHMARK(majorant_grid)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace vdbeam
