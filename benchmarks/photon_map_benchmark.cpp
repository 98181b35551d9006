#include "photon_scene.h"

#include <benchmark/benchmark.h>

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
BENCHMARK(beam_tiles)
    ->ArgNames({"photons", "k", "width", "height", "g100"})
    ->Args({1000000, 32, 512, 512, 0})
    ->Args({1000000, 32, 512, 512, 60})
    ->Args({200000, 1000, 320, 180, 0})
    ->Args({200000, 1000, 320, 180, 60})
    ->Args({200000, 1000, 320, 180, 95})
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace vdbeam::benchmarks
