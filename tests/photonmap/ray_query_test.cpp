#include "photonmap/query_cases.h"

namespace vdbeam {
namespace {

using oracle::MapOptions;
using oracle::TestMap;

struct RayCase {
  Vec3d origin, direction;
  double t_begin, t_end;
};

/// Normalised ball kernels of radius 1 by s = d^2.
double ball_kernel(KernelShape shape, double s) {
  switch (shape) {
  case KernelShape::constant:
    return 3 / (4 * std::numbers::pi);
  case KernelShape::epanechnikov:
    return 15 / (8 * std::numbers::pi) * (1 - s);
  case KernelShape::biweight:
    return 105 / (32 * std::numbers::pi) * (1 - s) * (1 - s);
  }
  return 0;
}

/// Rays along axes and at random, from inside, near and far away, over part of the photons or all.
std::vector<RayCase> ray_cases() {
  Rng rng({}, RngStage::test, 5);
  std::vector<RayCase> cases{
      {{0.1, 0.2, -3}, {0, 0, 1}, 0, 6}, {{0.1, 0.2, -3}, {0, 0, 1}, 2.5, 3.1},
      {{-3, 0.1, 0.2}, {1, 0, 0}, 0, 6}, {{0.3, 4, -0.1}, {0, -1, 0}, 0, 9},
      {{0, 0, 0}, {0.6, 0.8, 0}, 0, 3},  {{0.2, 0.1, -1e4}, {0, 0, 1}, 9998, 10002},
      {{5, 5, 5}, {1, 1, 1}, 0, 10}, // leaves the photons behind
  };
  for (int i = 0; i < 40; ++i) {
    const Vec3d target(oracle::random_point(rng));
    const Vec3d direction(sample_sphere(rng.uniform(), rng.uniform()));
    const double distance = i % 2 ? 4 : 0.5;
    cases.push_back({target - direction * distance, direction, 0, distance + 2});
  }
  return cases;
}

/// One ray against the oracle.
void expect_ray(const TestMap& map, const RayCase& ray, const std::vector<PhaseFunction>& phases,
                int weight_channels) {
  constexpr int knots = 30;
  Rng rng({}, RngStage::test, 9);
  std::vector<float> weights;
  for (std::size_t i = 0; i < phases.size() * knots * static_cast<std::size_t>(weight_channels);
       ++i)
    weights.push_back(0.5f + rng.uniform());
  PhotonMap::RayProfile profile;
  profile.ray = {Vec3f(ray.origin), Vec3f(normalize(ray.direction))};
  profile.t_begin = static_cast<float>(ray.t_begin);
  profile.step = static_cast<float>((ray.t_end - ray.t_begin) / (knots - 1));
  profile.knots = knots;
  profile.weights = weights.data();
  profile.weight_channels = weight_channels;
  profile.phases = &phases;

  const auto weight = [&](std::size_t g, int c, int k) -> double {
    return weights[(g * static_cast<std::size_t>(weight_channels) + c) * knots + k];
  };
  const auto placed = oracle::place(
      map, [&](const Vec3f& p) { return Vec3d(p) - Vec3d(profile.ray.origin); },
      [](const Vec3f& v) { return Vec3d(v); });
  const oracle::Edges edges{1e-4, 1e-3};
  const oracle::Sum sum =
      oracle::ray_sum(map, placed, Vec3d(profile.ray.direction), phases,
                      {profile.t_begin, profile.step, knots, weight_channels, weight}, edges);
  oracle::on_every_target([&] {
    Rgb radiance(0);
    const QueryCounts counts = query_ray(map.view(), profile, radiance);
    EXPECT_GE(counts.contributions, sum.contributions);
    EXPECT_LE(counts.contributions, sum.contributions + sum.doubtful);
    for (int c = 0; c < std::max(map.blocks.channels(), weight_channels); ++c)
      EXPECT_NEAR(radiance[c], sum.value[c],
                  sum.doubt[c] + (5e-5 + oracle::phase_rounding(phases)) * sum.magnitude[c]);
    if (map.blocks.channels() == 1 && weight_channels == 1) {
      EXPECT_EQ(radiance.y, radiance.x);
      EXPECT_EQ(radiance.z, radiance.x);
    }
  });
  oracle::expect_same_bits([&]() -> std::vector<float> {
    Rgb radiance(0);
    query_ray(map.view(), profile, radiance);
    return {radiance.x, radiance.y, radiance.z};
  });
}

TEST(RayQuery, MatchesOracle) {
  const auto phase_sets = oracle::phase_sets();
  const auto cases = ray_cases();
  std::uint64_t seed = 1;
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::epanechnikov, KernelShape::biweight})
    for (const auto& [power, weight] : {std::pair(1, 1), {3, 1}, {3, 3}, {1, 3}}) {
      MapOptions options;
      options.shape = shape;
      options.channels = power;
      options.seed = ++seed;
      const TestMap map = oracle::random_map(options);
      for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "ray " << i << " shape " << static_cast<int>(shape));
        expect_ray(map, cases[i], phase_sets[i % phase_sets.size()], weight);
      }
    }
}

/// A point query against double precision.
void expect_point(const TestMap& map, const Vec3f& point, const Vec3f& direction,
                  const std::vector<PhaseFunction>& phases) {
  const PhotonBlocks& blocks = map.blocks;
  std::vector<Vec3d> sums(phases.size()), magnitudes(phases.size());
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const Vec3d q = Vec3d(blocks.position(i)) - Vec3d(point);
    const double radius = blocks.at(i, PhotonBlocks::radius), s = dot(q, q) / (radius * radius);
    if (s >= 1)
      continue;
    const int df = blocks.direction_field();
    const double cosine =
        blocks.has_directions()
            ? -dot(Vec3d(blocks.at(i, df), blocks.at(i, df + 1), blocks.at(i, df + 2)),
                   Vec3d(direction))
            : 0;
    for (std::size_t g = 0; g < phases.size(); ++g)
      for (int c = 0; c < 3; ++c) {
        const double factor =
            (blocks.has_directions() ? oracle::phase(phases[g], cosine) : 1 / (4 * M_PI)) *
            blocks.at(i, PhotonBlocks::power + c % blocks.channels()) / std::pow(radius, 3);
        sums[g][c] += ball_kernel(map.shape, s) * factor;
        magnitudes[g][c] += ball_kernel(map.shape, 0) * factor;
      }
  }
  oracle::on_every_target([&] {
    std::vector<Rgb> values(phases.size(), Rgb(7));
    query_point(map.view(), point, direction, phases, values.data());
    for (std::size_t g = 0; g < phases.size(); ++g)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(values[g][c], sums[g][c],
                    (2e-5 + oracle::phase_rounding(phases)) * magnitudes[g][c]);
  });
  oracle::expect_same_bits([&] {
    std::vector<Rgb> values(phases.size());
    query_point(map.view(), point, direction, phases, values.data());
    std::vector<float> channels;
    for (const Rgb& value : values)
      channels.insert(channels.end(), {value.x, value.y, value.z});
    return channels;
  });
}

TEST(PointQuery, MatchesOracle) {
  const auto phase_sets = oracle::phase_sets();
  Rng rng({}, RngStage::test, 6);
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::epanechnikov, KernelShape::biweight})
    for (const int channels : {1, 3})
      for (const bool directions : {false, true}) {
        MapOptions options;
        options.shape = shape;
        options.channels = channels;
        options.directions = directions;
        options.greatest_radius = 0.4f;
        const TestMap map = oracle::random_map(options);
        for (std::size_t i = 0; i < 30; ++i)
          expect_point(map, oracle::random_point(rng) * 1.2f,
                       sample_sphere(rng.uniform(), rng.uniform()),
                       phase_sets[i % phase_sets.size()]);
      }
}

/// More phase functions than one walk serves.
TEST(PointQuery, TakesManyPhaseFunctions) {
  std::vector<PhaseFunction> phases;
  for (int i = 0; i < 11; ++i)
    phases.push_back(oracle::henyey_greenstein(0.15 * (i - 5)));
  MapOptions options;
  options.greatest_radius = 0.5f;
  expect_point(oracle::random_map(options), {0.1f, 0, 0}, {0, 0, 1}, phases);
}

/// A tile's rays one by one give what the tile gives.
TEST(RayQuery, AgreesWithTile) {
  const TestMap map = oracle::random_map({});
  const std::vector<PhaseFunction> phases{oracle::two_lobes()};
  oracle::TileOptions options;
  options.pixel = 0.05;
  BeamTile tile = oracle::make_tile(options, phases);
  query_tile(map.view(), tile);
  for (int r = 0; r < BeamTile::ray_count; r += 7) {
    const BeamTile::Profile& p = tile.profiles[r / 16];
    std::vector<float> weights;
    for (int k = 0; k < p.knots; ++k)
      weights.push_back(tile.weights[p.offset + static_cast<std::size_t>(16 * k + r % 16)]);
    PhotonMap::RayProfile profile;
    profile.ray.origin = tile.reference - tile.axis_w * static_cast<float>(tile.camera_distance);
    profile.ray.direction =
        tile.axis_u * tile.du[r] + tile.axis_v * tile.dv[r] + tile.axis_w * tile.dw[r];
    profile.t_begin = static_cast<float>(p.t_begin);
    profile.step = p.step;
    profile.knots = p.knots;
    profile.weights = weights.data();
    profile.phases = &phases;
    Rgb radiance(0);
    query_ray(map.view(), profile, radiance);
    EXPECT_NEAR(tile.radiance[static_cast<std::size_t>(r)], radiance.x, 1e-3 * radiance.x + 1e-3);
  }
}

} // namespace
} // namespace vdbeam
