#include "photon_scene.h"

#include "photonmap/map_queries.h"

#include <benchmark/benchmark.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace vdbeam::benchmarks {
namespace {

const NoisyBall& ball() {
  static const NoisyBall shared;
  return shared;
}

const PhotonList& photons(std::size_t count) {
  static std::map<std::size_t, PhotonList> made;
  PhotonList& list = made[count];
  if (list.size() == 0)
    list = walk_photons(ball(), count, true);
  return list;
}

const PhotonMap& photon_map(std::size_t count, float neighbours, bool directions) {
  static std::map<std::tuple<std::size_t, float, bool>, PhotonMap> made;
  auto& map = made[{count, neighbours, directions}];
  if (map.size() == 0) {
    PhotonList list = photons(count);
    if (!directions)
      list.direction.clear();
    RadiusSettings radii;
    radii.neighbours = neighbours;
    map = PhotonMap::build(std::move(list), 1, radii, KernelShape::biweight);
  }
  return map;
}

PhaseFunction forward_phase(double g) {
  PhaseSettings settings;
  settings.type = PhaseType::henyey_greenstein;
  settings.g = g;
  return PhaseFunction(settings);
}

/// All tiles of an image, one thread. Arguments: photons, neighbours, width, height, 100 g.
void beam_tiles(benchmark::State& state) {
  const auto g = static_cast<double>(state.range(4)) / 100;
  const PhotonMap& map = photon_map(static_cast<std::size_t>(state.range(0)),
                                    static_cast<float>(state.range(1)), g != 0);
  const std::vector<PhaseFunction> phases(1, g != 0 ? forward_phase(g) : PhaseFunction());
  std::vector<BeamTile> tiles = camera_tiles(ball(), static_cast<int>(state.range(2)),
                                             static_cast<int>(state.range(3)), phases);
  QueryCounts counts;
  for (auto _ : state)
    for (BeamTile& tile : tiles) {
      const QueryCounts c = map.query(tile);
      counts.contributions += c.contributions;
      counts.candidates += c.candidates;
      counts.blocks += c.blocks;
    }
  const auto rounds = static_cast<double>(state.iterations());
  const double contributions = static_cast<double>(counts.contributions);
  state.counters["contributions"] = contributions / rounds;
  state.counters["per_ray"] =
      contributions / rounds / static_cast<double>(tiles.size() * BeamTile::ray_count);
  state.counters["candidate_share"] = contributions / static_cast<double>(counts.candidates);
  state.counters["ns_per_contribution"] = benchmark::Counter(
      contributions * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
void image_arguments(benchmark::internal::Benchmark* b) {
  b->ArgNames({"photons", "k", "width", "height", "g100"})
      ->Args({1000000, 32, 512, 512, 0})
      ->Args({1000000, 32, 512, 512, 60})
      ->Args({200000, 1000, 320, 180, 0})
      ->Args({200000, 1000, 320, 180, 60})
      ->Args({200000, 1000, 320, 180, 95})
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK(beam_tiles)->Apply(image_arguments);

/// The same confined to AVX2.
void beam_tiles_avx2(benchmark::State& state) {
  confine_simd_targets(HWY_AVX2);
  beam_tiles(state);
  confine_simd_targets(0);
}
BENCHMARK(beam_tiles_avx2)->Apply(image_arguments);

/// The same on all threads, by wall clock.
void beam_tiles_parallel(benchmark::State& state) {
  const PhotonMap& map = photon_map(static_cast<std::size_t>(state.range(0)),
                                    static_cast<float>(state.range(1)), false);
  const std::vector<PhaseFunction> phases(1);
  std::vector<BeamTile> tiles = camera_tiles(ball(), static_cast<int>(state.range(2)),
                                             static_cast<int>(state.range(3)), phases);
  for (auto _ : state)
    tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) { map.query(tiles[i]); });
}
BENCHMARK(beam_tiles_parallel)
    ->ArgNames({"photons", "k", "width", "height"})
    ->Args({1000000, 32, 512, 512})
    ->Args({200000, 1000, 320, 180})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The rays of every eighth row of tiles one by one. Arguments: photons, neighbours, width, height.
void single_rays(benchmark::State& state) {
  const PhotonMap& map = photon_map(static_cast<std::size_t>(state.range(0)),
                                    static_cast<float>(state.range(1)), false);
  const std::vector<PhaseFunction> phases(1);
  std::vector<BeamTile> tiles = camera_tiles(ball(), static_cast<int>(state.range(2)),
                                             static_cast<int>(state.range(3)), phases);
  std::uint64_t contributions = 0, rays = 0;
  std::vector<float> weights;
  for (auto _ : state)
    for (std::size_t i = 3; i < tiles.size(); i += 8) {
      const BeamTile& tile = tiles[i];
      for (int r = 0; r < BeamTile::ray_count; r += 5, ++rays) {
        const BeamTile::Profile& p = tile.profiles[r / 16];
        weights.resize(static_cast<std::size_t>(p.knots));
        for (int k = 0; k < p.knots; ++k)
          weights[static_cast<std::size_t>(k)] =
              tile.weights[p.offset + static_cast<std::size_t>(16 * k + r % 16)];
        PhotonMap::RayProfile profile;
        profile.ray = {tile.reference - tile.axis_w * static_cast<float>(tile.camera_distance),
                       tile.axis_u * tile.du[r] + tile.axis_v * tile.dv[r] +
                           tile.axis_w * tile.dw[r]};
        profile.t_begin = static_cast<float>(p.t_begin);
        profile.step = p.step;
        profile.knots = p.knots;
        profile.weights = weights.data();
        profile.phases = &phases;
        Rgb radiance(0);
        contributions += map.query_ray(profile, radiance).contributions;
        benchmark::DoNotOptimize(radiance);
      }
    }
  state.counters["per_ray"] = static_cast<double>(contributions) / static_cast<double>(rays);
  state.counters["ns_per_contribution"] =
      benchmark::Counter(static_cast<double>(contributions) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(single_rays)
    ->ArgNames({"photons", "k", "width", "height"})
    ->Args({1000000, 32, 512, 512})
    ->Args({200000, 1000, 320, 180})
    ->Unit(benchmark::kMillisecond);

/// Order, radii and boxes. Arguments: photons, neighbours, threads.
void map_build(benchmark::State& state) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(2)));
  const PhotonList& list = photons(static_cast<std::size_t>(state.range(0)));
  RadiusSettings radii;
  radii.neighbours = static_cast<float>(state.range(1));
  MapTimes times;
  std::size_t bytes = 0;
  for (auto _ : state) {
    state.PauseTiming();
    PhotonList copy = list;
    state.ResumeTiming();
    const PhotonMap map = PhotonMap::build(std::move(copy), 1, radii, KernelShape::biweight);
    times.order += map.times().order;
    times.radii += map.times().radii;
    times.build += map.times().build;
    bytes = map.bytes();
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["order_ms"] = 1000 * times.order / rounds;
  state.counters["radii_ms"] = 1000 * times.radii / rounds;
  state.counters["boxes_ms"] = 1000 * times.build / rounds;
  state.counters["bytes_per_photon"] =
      static_cast<double>(bytes) / static_cast<double>(list.size());
}
BENCHMARK(map_build)
    ->ArgNames({"photons", "k", "threads"})
    ->Args({1000000, 32, 1})
    ->Args({1000000, 128, 1})
    ->Args({1000000, 1000, 1})
    ->Args({200000, 1000, 1})
    ->Args({1000000, 32, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace vdbeam::benchmarks
