#include "photonmap/query_cases.h"

namespace vdbeam {
namespace {

using oracle::MapOptions;
using oracle::TestMap;
using oracle::TileOptions;

/// The tile against the oracle: beyond what the oracle grants each photon, errors relative to the
/// terms' magnitude.
void expect_tile(const TestMap& map, BeamTile& tile, const std::vector<oracle::Sum>& sums,
                 double tolerance) {
  std::fill(tile.radiance.begin(), tile.radiance.end(), 0.0f);
  const QueryCounts counts = query_tile(map.view(), tile);
  const int channels = std::max(map.blocks.channels(), tile.weight_channels);
  double worst = 0, total = 0;
  std::uint64_t certain = 0, possible = 0;
  for (int r = 0; r < BeamTile::ray_count; ++r) {
    const oracle::Sum& sum = sums[static_cast<std::size_t>(r)];
    certain += sum.contributions;
    possible += sum.contributions + sum.doubtful;
    for (int c = 0; c < channels; ++c) {
      const double value = tile.radiance[static_cast<std::size_t>(c * BeamTile::ray_count + r)];
      ASSERT_TRUE(std::isfinite(value));
      total += sum.magnitude[c];
      const double error =
          std::max(0.0, std::abs(value - sum.value[c]) - sum.doubt[c] - sum.leeway[c]);
      worst = std::max(worst, sum.magnitude[c] > 0 ? error / sum.magnitude[c] : error);
    }
  }
  EXPECT_GT(total, 0);
  EXPECT_LT(worst, tolerance);
  EXPECT_GE(counts.contributions, certain);
  EXPECT_LE(counts.contributions, possible);
}

/// Relative tolerance for rounding; what rays share is bounded photon by photon.
constexpr double tolerance = 2e-5;

struct TileCase {
  const char* name;
  TileOptions tile;
  MapOptions map;
  oracle::Edges edges;
  bool shared = false; ///< rays of a sub-tile share knots, distances and phase
  /// Relative, by starts in single precision that are far away in units of a kernel's radius.
  double rounding_of_starts = 0;
};

class TileQuery : public testing::TestWithParam<TileCase> {};

/// Shapes x phases x channels of photons and weights, on every SIMD target.
TEST_P(TileQuery, MatchesOracle) {
  const TileCase& param = GetParam();
  const auto phase_sets = oracle::phase_sets();
  std::uint64_t seed = 1;
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::epanechnikov, KernelShape::biweight})
    for (std::size_t p = 0; p < phase_sets.size(); ++p)
      for (const auto& [power, weight] : {std::pair(1, 1), {3, 1}, {3, 3}}) {
        // Every pair of choices occurs, not every triple.
        if ((static_cast<int>(shape) + static_cast<int>(p) + power + weight) % 2)
          continue;
        MapOptions map_options = param.map;
        map_options.shape = shape;
        map_options.channels = power;
        map_options.seed = seed++;
        TileOptions tile_options = param.tile;
        tile_options.weight_channels = weight;
        const TestMap map = oracle::random_map(map_options);
        BeamTile tile = oracle::make_tile(tile_options, phase_sets[p]);
        SCOPED_TRACE(testing::Message() << "shape " << static_cast<int>(shape) << " phases " << p
                                        << " power " << power << " weight " << weight);
        const std::vector<oracle::Sum> sums =
            oracle::tile_sums(map, tile, param.edges, param.shared);
        const double allowed =
            tolerance + param.rounding_of_starts + oracle::phase_rounding(phase_sets[p]);
        oracle::on_every_target([&] { expect_tile(map, tile, sums, allowed); });
        oracle::expect_same_bits([&] {
          std::fill(tile.radiance.begin(), tile.radiance.end(), 0.0f);
          query_tile(map.view(), tile);
          return tile.radiance;
        });
      }
}

constexpr oracle::Edges shared_edges{1e-3, 0.3};
constexpr oracle::Edges preview_edges{5e-3, 0.5}; ///< the widest cones that share
constexpr oracle::Edges exact_edges{};

INSTANTIATE_TEST_SUITE_P(
    Scenes, TileQuery,
    testing::Values(
        TileCase{"near_narrow", {}, {}, shared_edges, true},
        TileCase{"far", {.distance = 1e4, .pixel = 5e-6}, {}, shared_edges, true},
        TileCase{"axis_aligned", {.direction = {0, 0, 1}}, {}, shared_edges, true},
        TileCase{"inside", {.distance = 0.3, .pixel = 0.004}, {}, shared_edges, true},
        TileCase{"wide", {.distance = 2, .pixel = 0.08, .smooth = false}, {}, exact_edges},
        TileCase{"wide_inside", {.distance = 0, .pixel = 0.08, .smooth = false}, {}, exact_edges},
        TileCase{"fisheye", {.distance = 0.5, .pixel = 0.4, .smooth = false}, {}, exact_edges},
        TileCase{"preview", {.pixel = 0.0145}, {}, preview_edges, true},
        TileCase{"fine_knots", {.pixel = 0.02, .knots = 700, .smooth = false}, {}, exact_edges},
        TileCase{"lens", {.lens = 0.2, .focus = 6}, {}, exact_edges},
        TileCase{"lens_focused_before", {.pixel = 0.02, .lens = 0.4, .focus = 3}, {}, exact_edges},
        TileCase{"lens_inside",
                 {.distance = 0.5, .pixel = 0.03, .smooth = false, .lens = 0.3, .focus = 1},
                 {},
                 exact_edges},
        TileCase{"lens_wider_than_its_focus",
                 {.t_end = 30, .knots = 300, .smooth = false, .lens = 25, .focus = 6},
                 {},
                 exact_edges,
                 false,
                 3e-5},
        TileCase{"parallel", {.distance = 3, .lens = 0.5}, {}, exact_edges},
        TileCase{"few_photons", {.pixel = 0.03}, {.count = 3, .greatest_radius = 1}, exact_edges}),
    [](const auto& test) { return test.param.name; });

/// A surface may end a ray before it meets the medium that the other rays of its sub-tile see.
/// Where that is seen edge-on, knots lie so close that such a ray ends a hundred million of them
/// before the first.
TEST(TileQuery, RaysThatEndBeforeTheTableGatherNothing) {
  MapOptions options;
  options.count = 20000;
  options.channels = 3;
  options.directions = false;
  const TestMap map = oracle::random_map(options);
  BeamTile tile;
  tile.axis_u = {1, 0, 0};
  tile.axis_v = {0, 1, 0};
  tile.axis_w = {0, 0, 1};
  tile.camera_distance = 5;
  for (int i = 0; i < BeamTile::ray_count; ++i) {
    const float x = 0.01f * static_cast<float>(i % 16 - 8),
                y = 0.01f * static_cast<float>(i / 16 - 8);
    const float scale = 1 / std::sqrt(1 + x * x + y * y);
    tile.du[i] = x * scale;
    tile.dv[i] = y * scale;
    tile.dw[i] = scale;
    tile.end[static_cast<std::size_t>(i)] = i % 16 == 0 ? 6.0 : 4.2;
  }
  const int knots = 17;
  for (BeamTile::Profile& profile : tile.profiles) {
    profile.t_begin = 5;
    profile.step = 1e-8f;
    profile.knots = knots;
    profile.offset = tile.weights.size();
    tile.weights.resize(profile.offset + knots * 16, 1.0f);
  }
  const std::vector<PhaseFunction> phases(1);
  tile.phases = &phases;
  tile.radiance.assign(3 * BeamTile::ray_count, 0);
  query_tile(map.view(), tile);
  for (std::size_t i = 0; i < tile.radiance.size(); ++i) {
    ASSERT_TRUE(std::isfinite(tile.radiance[i]));
    EXPECT_TRUE(i % 16 == 0 || tile.radiance[i] == 0) << i;
  }
}

/// Knots so fine that the rays of a sub-tile disagree on them by several: what they share is then a
/// photon moved by far less than its radius, which must not change the light as a whole. The sum
/// over the tile has about 1000 independent photons with weights that differ by half from knot to
/// knot; exchanging a knot for its neighbour changes it by less than 0.5 / sqrt(1000) = 1.6 %.
TEST(TileQuery, SharedFineKnotsKeepTheLight) {
  MapOptions map_options;
  map_options.count = 4000;
  const TestMap map = oracle::random_map(map_options);
  TileOptions options;
  options.knots = 1000;
  options.smooth = false;
  const std::vector<PhaseFunction> phases{oracle::henyey_greenstein(0.6)};
  BeamTile tile = oracle::make_tile(options, phases);
  query_tile(map.view(), tile);
  double value = 0, expected = 0;
  for (const float radiance : tile.radiance)
    value += radiance;
  for (const oracle::Sum& sum : oracle::tile_sums(map, tile, exact_edges))
    expected += sum.value[0] + sum.doubt[0];
  EXPECT_NEAR(value, expected, 0.016 * expected);
}

} // namespace
} // namespace vdbeam
