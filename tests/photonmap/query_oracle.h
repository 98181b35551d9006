#pragma once

#include "math/rng.h"
#include "math/sampling.h"
#include "photonmap/map_queries.h"

#include <functional>

namespace vdbeam::oracle {

/// Photons with radii of their own, as the queries see them.
struct TestMap {
  PhotonBlocks blocks;
  BlockTree tree;
  KernelShape shape = KernelShape::biweight;
  float mean_radius = 0;

  MapView view() const { return {blocks, tree, shape, mean_radius}; }
};

struct MapOptions {
  std::size_t count = 1000;
  int channels = 1;
  bool directions = true;
  KernelShape shape = KernelShape::biweight;
  float least_radius = 0.05f, greatest_radius = 0.15f;
  std::uint64_t seed = 1;
};

inline Vec3f random_point(Rng& rng) {
  return Vec3f{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
}

/// Photons in [-1, 1]^3, sorted along x so that blocks are slabs: any order is legal.
inline TestMap random_map(const MapOptions& options) {
  Rng rng({}, RngStage::test, options.seed);
  TestMap map;
  map.shape = options.shape;
  std::vector<Vec3f> positions;
  for (std::size_t i = 0; i < options.count; ++i)
    positions.push_back(random_point(rng));
  std::sort(positions.begin(), positions.end(),
            [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; });
  map.blocks = PhotonBlocks(options.count, options.channels, options.directions);
  for (std::size_t i = 0; i < options.count; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      map.blocks.at(i, axis) = positions[i][axis];
    const float radius =
        options.least_radius + rng.uniform() * (options.greatest_radius - options.least_radius);
    map.blocks.at(i, PhotonBlocks::radius) = radius;
    map.mean_radius += radius / static_cast<float>(options.count);
    for (int c = 0; c < options.channels; ++c)
      map.blocks.at(i, PhotonBlocks::power + c) = 0.5f + rng.uniform();
    const Vec3f direction = sample_sphere(rng.uniform(), rng.uniform());
    if (options.directions)
      for (int axis = 0; axis < 3; ++axis)
        map.blocks.at(i, map.blocks.direction_field() + axis) = direction[axis];
  }
  map.tree = build_block_tree(map.blocks);
  return map;
}

inline double phase(const PhaseFunction& function, double cosine) {
  double sum = 0;
  for (int i = 0; i < function.lobe_count(); ++i) {
    const double g = function.lobe(i).g, alpha = function.lobe(i).alpha;
    sum += function.lobe(i).weight * (1 - g * g) / (4 * M_PI) /
           std::pow(1 + g * g - 2 * g * cosine, 1.5) * (1 + alpha * cosine * cosine) /
           (1 + alpha * (1 + 2 * g * g) / 3);
  }
  return sum;
}

inline double disc(KernelShape shape, double s) {
  switch (shape) {
  case KernelShape::constant:
    return 1 / M_PI;
  case KernelShape::epanechnikov:
    return 2 / M_PI * (1 - s);
  case KernelShape::biweight:
    return 3 / M_PI * (1 - s) * (1 - s);
  }
  return 0;
}

/// One ray's sum in double precision.
struct Sum {
  double value[3] = {};
  double magnitude[3] =
      {};                ///< of the terms with the kernel at its greatest: what rounding relates to
  double doubt[3] = {};  ///< terms so near an edge that rounding decides whether they count
  double leeway[3] = {}; ///< bound of what photons change that are seen a little off (see Sharing)
  std::uint64_t contributions = 0, doubtful = 0;
};

/// Single-precision coordinates of size 1 to 2, turned into another frame.
constexpr double position_rounding = 5e-7;

/// Distance to an edge below which the result is ambiguous, in s and in knots.
struct Edges {
  double kernel = 1e-5, knots = 1e-3;
};

/// A map's photons as seen from a ray's origin, in a frame of choice.
struct PlacedPhotons {
  std::vector<Vec3d> position, direction;
};

inline PlacedPhotons place(const TestMap& map, const std::function<Vec3d(const Vec3f&)>& point,
                           const std::function<Vec3d(const Vec3f&)>& vector) {
  PlacedPhotons placed;
  const PhotonBlocks& blocks = map.blocks;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    placed.position.push_back(point(blocks.position(i)));
    const int df = blocks.direction_field();
    placed.direction.push_back(
        blocks.has_directions()
            ? vector({blocks.at(i, df), blocks.at(i, df + 1), blocks.at(i, df + 2)})
            : Vec3d{});
  }
  return placed;
}

struct RayWeights {
  double t_begin, step;
  int knots, channels;
  std::function<double(std::size_t group, int channel, int knot)> at;
};

/// Evaluates a ray that shares knots, distances and a linear phase function with the cone of rays
/// around it; all 0 for a ray on its own.
struct Sharing {
  double square = 0; ///< squared tangent of the ray's angle with the cone's axis
  double phase = 0;  ///< relative error of a linear phase function

  /// Along the axis a photon at distance t, off the ray by up to r, has another coordinate than
  /// along the ray: t / sqrt(1 + square), less or more by up to r times the tangent.
  double shift(double t, double r) const {
    return std::abs(t) * square / 2 + r * std::sqrt(square) + position_rounding;
  }
};

/// Bound of the change of disc(s) times weight where the weight may be off by `slope` and the
/// distance is measured in the plane across the axis: s grows by the share `square` at most, the
/// kernel's area by half of it.
inline double greatest_change(KernelShape shape, double s, double weight, double slope,
                              const Sharing& sharing) {
  constexpr double steepest[] = {0, 1, 2, 3}; // of the kernel by s, relative to its greatest value
  const double top = disc(shape, 0), value = std::abs(disc(shape, s));
  const double kernel = steepest[static_cast<int>(shape)] * top * s * sharing.square;
  return std::abs(weight) * (kernel + value * (sharing.square / 2 + sharing.phase)) +
         slope * (value + kernel);
}

inline Sum ray_sum(const TestMap& map, const PlacedPhotons& placed, const Vec3d& unnormalised,
                   const std::vector<PhaseFunction>& phases, const RayWeights& weights,
                   const Edges& edges, const Sharing& sharing = {}) {
  Sum sum;
  const Vec3d direction = normalize(unnormalised);
  const PhotonBlocks& blocks = map.blocks;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const Vec3d q = placed.position[i];
    const double radius = blocks.at(i, PhotonBlocks::radius);
    const Vec3d e = cross(q, direction);
    const double s = dot(e, e) / (radius * radius);
    const double f = (dot(q, direction) - weights.t_begin) / weights.step;
    const double past = std::max(-f, f - (weights.knots - 1));
    if (s >= 1 + edges.kernel || past > edges.knots)
      continue;
    const bool doubtful = s > 1 - edges.kernel || past > -edges.knots;
    const int k = std::clamp(static_cast<int>(f), 0, weights.knots - 2);
    const double fraction = std::clamp(f - k, 0.0, 1.0), area = radius * radius;
    const double cosine = -dot(direction, placed.direction[i]);
    const double shift = sharing.shift(dot(q, direction), radius) / weights.step;
    sum.contributions += !doubtful;
    sum.doubtful += doubtful;
    for (std::size_t g = 0; g < phases.size(); ++g)
      for (int c = 0; c < std::max(blocks.channels(), weights.channels); ++c) {
        const auto weight = [&](int knot) {
          return weights.at(g, c % weights.channels, std::clamp(knot, 0, weights.knots - 1));
        };
        const double w = weight(k) + fraction * (weight(k + 1) - weight(k));
        const double factor =
            (blocks.has_directions() ? phase(phases[g], cosine) : 1 / (4 * M_PI)) *
            blocks.at(i, PhotonBlocks::power + c % blocks.channels()) / area;
        const double term = disc(map.shape, s) * factor * w;
        (doubtful ? sum.doubt : sum.value)[c] += doubtful ? std::abs(term) : term;
        sum.magnitude[c] += disc(map.shape, 0) * factor * w;
        double slope = 0; // greatest within a knot, which `shift` is less than
        for (int j = k - 1; j <= k + 1; ++j)
          slope = std::max(slope, std::abs(weight(j + 1) - weight(j)));
        sum.leeway[c] += factor * greatest_change(map.shape, s, w, slope * shift, sharing);
      }
  }
  return sum;
}

struct TileOptions {
  double distance = 6;  ///< of the camera from the reference
  double pixel = 0.005; ///< tangent between neighbouring rays
  Vec3d direction{0.3, -0.2, 0.9};
  Vec3f reference{0.1f, 0.05f, -0.1f};
  double t_begin = -1.8, t_end = 1.8; ///< relative to the reference; cut at the camera
  int knots = 40;
  int weight_channels = 1;
  bool smooth = true; ///< weights vary slowly along the ray, and end at 0
  /// Rays start on a square of this half width that is tilted against the tile, and meet, pixel by
  /// pixel, where the pinhole's rays are at the distance `focus` (0: all go along the tile's axis).
  double lens = 0, focus = 0;
};

/// Gives a ray an origin of its own.
inline void add_lens(const TileOptions& options, int ray, const Vec3d& pinhole, Rng& rng,
                     BeamTile& tile) {
  const double x = options.lens * (2 * rng.uniform() - 1),
               y = options.lens * (2 * rng.uniform() - 1);
  const Vec3d start{x, y, 0.3 * x - 0.2 * y};
  const Vec3d d = options.focus > 0 ? normalize(pinhole * options.focus - start) : Vec3d{0, 0, 1};
  tile.own_origins = true;
  tile.ou[ray] = static_cast<float>(start.x);
  tile.ov[ray] = static_cast<float>(start.y);
  tile.ow[ray] = static_cast<float>(start.z);
  tile.du[ray] = static_cast<float>(d.x);
  tile.dv[ray] = static_cast<float>(d.y);
  tile.dw[ray] = static_cast<float>(d.z);
}

inline BeamTile make_tile(const TileOptions& options, const std::vector<PhaseFunction>& phases) {
  BeamTile tile;
  const Vec3d w = normalize(options.direction);
  Vec3d u, v;
  orthonormal_frame(w, u, v);
  tile.axis_u = Vec3f(u);
  tile.axis_v = Vec3f(v);
  tile.axis_w = Vec3f(w);
  tile.reference = options.reference;
  tile.camera_distance = static_cast<float>(options.distance);
  tile.phases = &phases;
  tile.weight_channels = options.weight_channels;
  const double t0 = std::max(0.0, options.distance + options.t_begin);
  const double t1 = options.distance + options.t_end;
  const std::size_t rows = phases.size() * static_cast<std::size_t>(options.weight_channels);
  Rng rng({}, RngStage::test, 77);
  for (int s = 0; s < BeamTile::subtile_count; ++s) {
    BeamTile::Profile& profile = tile.profiles[s];
    profile.t_begin = static_cast<float>(t0);
    profile.step = static_cast<float>((t1 - t0) / (options.knots - 1));
    profile.knots = options.knots;
    profile.offset = tile.weights.size();
    for (std::size_t row = 0; row < rows; ++row)
      for (int k = 0; k < options.knots; ++k)
        for (int r = 0; r < 16; ++r) {
          const double x = static_cast<double>(k) / (options.knots - 1);
          const double wave =
              1 + 0.5 * std::sin(6 * x + static_cast<double>(row) + 0.1 * s + 0.02 * r);
          tile.weights.push_back(options.smooth ? static_cast<float>(4 * x * (1 - x) * wave)
                                                : 0.5f + rng.uniform());
        }
    for (int r = 0; r < 16; ++r) {
      const double px = s % 4 * 4 + r % 4 - 7.5 + 0.3 * rng.uniform();
      const double py = s / 4 * 4 + r / 4 - 7.5 + 0.3 * rng.uniform();
      const Vec3d d = normalize(Vec3d{px * options.pixel, py * options.pixel, 1});
      tile.du[s * 16 + r] = static_cast<float>(d.x);
      tile.dv[s * 16 + r] = static_cast<float>(d.y);
      tile.dw[s * 16 + r] = static_cast<float>(d.z);
      if (options.lens > 0)
        add_lens(options, s * 16 + r, d, rng, tile);
    }
  }
  return tile;
}

/// What the rays of each sub-tile share where they do: the cone is that about their mean direction.
inline std::vector<Sharing> tile_sharing(const BeamTile& tile) {
  std::vector<Sharing> sharing(BeamTile::ray_count);
  const auto direction = [&](int ray) {
    return normalize(Vec3d{tile.du[ray], tile.dv[ray], tile.dw[ray]});
  };
  for (int s = 0; s < BeamTile::subtile_count; ++s) {
    Vec3d mean;
    double widest = 0;
    for (int r = 16 * s; r < 16 * s + 16; ++r)
      mean += direction(r);
    for (int r = 16 * s; r < 16 * s + 16; ++r) {
      const double cosine = dot(direction(r), normalize(mean));
      sharing[r].square = 1 / (cosine * cosine) - 1;
      widest = std::max(widest, std::sqrt(sharing[r].square));
    }
    // The second-order term of each lobe; where it is above 1e-3 nothing is linear.
    double error = 0;
    for (const PhaseFunction& phase : *tile.phases)
      for (int i = 0; i < phase.lobe_count(); ++i) {
        const double g = std::abs(phase.lobe(i).g), width = widest / (1 - g);
        error = std::max(error,
                         2 * g * width * width + std::abs(phase.lobe(i).alpha) * widest * widest);
      }
    for (int r = 16 * s; r < 16 * s + 16; ++r)
      sharing[r].phase = error < 1e-3 ? error : 0;
  }
  return sharing;
}

/// `shared`: whether the rays of a sub-tile are so near to each other that they share.
inline std::vector<Sum> tile_sums(const TestMap& map, const BeamTile& tile, const Edges& edges,
                                  bool shared = false) {
  const std::vector<Sharing> sharing =
      shared ? tile_sharing(tile) : std::vector<Sharing>(BeamTile::ray_count);
  const auto turn = [&](const Vec3f& p) {
    return Vec3d{dot(Vec3d(tile.axis_u), Vec3d(p)), dot(Vec3d(tile.axis_v), Vec3d(p)),
                 dot(Vec3d(tile.axis_w), Vec3d(p))};
  };
  const Vec3d origin = turn(tile.reference) - Vec3d{0, 0, tile.camera_distance};
  PlacedPhotons placed = place(
      map, [&](const Vec3f& p) { return turn(p) - origin; }, turn);
  std::vector<Sum> sums;
  for (int ray = 0; ray < BeamTile::ray_count; ++ray) {
    if (tile.own_origins)
      placed = place(
          map,
          [&](const Vec3f& p) {
            return turn(p) - origin - Vec3d{tile.ou[ray], tile.ov[ray], tile.ow[ray]};
          },
          turn);
    const BeamTile::Profile& profile = tile.profiles[ray / 16];
    const auto weight = [&](std::size_t g, int c, int k) -> double {
      const std::size_t row = g * static_cast<std::size_t>(tile.weight_channels) + c;
      return tile.weights[profile.offset + (row * profile.knots + k) * 16 + ray % 16];
    };
    sums.push_back(
        ray_sum(map, placed, {tile.du[ray], tile.dv[ray], tile.dw[ray]}, *tile.phases,
                {profile.t_begin, profile.step, profile.knots, tile.weight_channels, weight}, edges,
                sharing[static_cast<std::size_t>(ray)]));
  }
  return sums;
}

} // namespace vdbeam::oracle
