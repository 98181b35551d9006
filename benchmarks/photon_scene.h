#pragma once

#include "math/rng.h"
#include "math/sampling.h"
#include "photonmap/photon_map.h"

#include <map>
#include <memory>

namespace vdbeam::benchmarks {

/// A noisy ball of radius 1 and central optical depth about 50, on a 128^3 lattice.
class NoisyBall {
public:
  static constexpr int size = 128;

  NoisyBall() : density_(static_cast<std::size_t>(size) * size * size) {
    for (int k = 0; k < size; ++k)
      for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) {
          const Vec3f p =
              (Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)) +
               Vec3f(0.5f)) *
                  (2.0f / size) -
              Vec3f(1);
          const float noise = 0.55f * value_noise(p * 4.0f) + 0.3f * value_noise(p * 9.0f) +
                              0.15f * value_noise(p * 20.0f);
          const float edge = std::clamp((1 - length(p)) * 8, 0.0f, 1.0f);
          cell(i, j, k) = edge * std::max(0.0f, 2.2f * noise - 0.35f) * 33;
        }
    for (const float d : density_)
      majorant_ = std::max(majorant_, d);
  }

  float at(const Vec3f& p) const {
    const int i = index(p.x), j = index(p.y), k = index(p.z);
    return dot(p, p) < 1 ? density_[static_cast<std::size_t>((k * size + j) * size + i)] : 0;
  }
  float majorant() const { return majorant_; }

private:
  float& cell(int i, int j, int k) {
    return density_[static_cast<std::size_t>((k * size + j) * size + i)];
  }
  static int index(float x) {
    return std::clamp(static_cast<int>((x + 1) * (0.5f * size)), 0, size - 1);
  }
  static float lattice(int i, int j, int k) {
    return static_cast<float>(
               mix64(static_cast<std::uint64_t>(((k + 64) * 256 + j + 64) * 256 + i + 64)) >> 40) *
           0x1p-24f;
  }
  static float value_noise(const Vec3f& p) {
    const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    float sum = 0;
    for (int c = 0; c < 8; ++c) {
      const float wx = c & 1 ? p.x - fx : 1 - (p.x - fx), wy = c & 2 ? p.y - fy : 1 - (p.y - fy),
                  wz = c & 4 ? p.z - fz : 1 - (p.z - fz);
      sum += wx * wy * wz *
             lattice(static_cast<int>(fx) + (c & 1), static_cast<int>(fy) + (c >> 1 & 1),
                     static_cast<int>(fz) + (c >> 2));
    }
    return sum;
  }

  std::vector<float> density_;
  float majorant_ = 0;
};

/// Photons at the collisions of random walks from one side into the ball.
inline PhotonList walk_photons(const NoisyBall& ball, std::size_t count, bool directions) {
  PhotonList photons;
  photons.position.reserve(count);
  for (std::uint64_t path = 0; photons.size() < count; ++path) {
    Rng rng({}, RngStage::test, path);
    Vec3f p{2 * rng.uniform() - 1, 1.2f, 2 * rng.uniform() - 1}, d{0.35f, -0.9f, 0.25f};
    d = normalize(d);
    for (int bounce = 0; bounce < 1000 && photons.size() < count;) {
      p += d * (-std::log(rng.uniform_positive()) / ball.majorant());
      if (dot(p, p) > 4)
        break;
      if (rng.uniform() * ball.majorant() >= ball.at(p))
        continue;
      photons.position.push_back(p);
      photons.power.push_back(Rgb(1.0f / static_cast<float>(count)));
      if (directions)
        photons.direction.push_back(d);
      ++bounce;
      if (rng.uniform() > 0.99f)
        break;
      d = sample_sphere(rng.uniform(), rng.uniform());
    }
  }
  return photons;
}

/// The tiles of an image of the ball, with uniform depth profiles.
inline std::vector<BeamTile> camera_tiles(const NoisyBall& ball, int width, int height,
                                          const std::vector<PhaseFunction>& phases,
                                          int knots = 64) {
  const float distance = 6, tangent = 1.1f / distance;
  std::vector<BeamTile> tiles;
  for (int y0 = 0; y0 < height; y0 += 16)
    for (int x0 = 0; x0 < width; x0 += 16) {
      BeamTile& tile = tiles.emplace_back();
      const auto direction = [&](float x, float y) {
        const float s = 2 * tangent / static_cast<float>(height);
        return normalize(Vec3f{(x - 0.5f * static_cast<float>(width)) * s,
                               (0.5f * static_cast<float>(height) - y) * s, -1});
      };
      tile.axis_w = direction(static_cast<float>(x0) + 8, static_cast<float>(y0) + 8);
      orthonormal_frame(tile.axis_w, tile.axis_u, tile.axis_v);
      tile.camera_distance = distance;
      tile.reference = Vec3f{0, 0, distance} + tile.axis_w * distance;
      tile.phases = &phases;
      tile.weights.assign(static_cast<std::size_t>(knots) * BeamTile::ray_count, 0);
      tile.radiance.assign(3 * BeamTile::ray_count, 0);
      for (int r = 0; r < BeamTile::ray_count; ++r) {
        const int sub = r / 16, lane = r % 16;
        Rng rng({}, RngStage::camera, static_cast<std::uint64_t>(r));
        const Vec3f d = direction(static_cast<float>(x0 + sub % 4 * 4 + lane % 4) + rng.uniform(),
                                  static_cast<float>(y0 + sub / 4 * 4 + lane / 4) + rng.uniform());
        tile.du[r] = dot(d, tile.axis_u);
        tile.dv[r] = dot(d, tile.axis_v);
        tile.dw[r] = dot(d, tile.axis_w);
        BeamTile::Profile& profile = tile.profiles[sub];
        profile = {distance - 1.05f, 2.1f / static_cast<float>(knots - 1), knots,
                   static_cast<std::size_t>(sub * knots) * 16};
        float tau = 0;
        for (int k = 0; k < knots; ++k) {
          const float sigma =
              ball.at(Vec3f{0, 0, distance} + d * (static_cast<float>(profile.t_begin) +
                                                   static_cast<float>(k) * profile.step));
          tau += sigma * profile.step;
          tile.weights[profile.offset + static_cast<std::size_t>(k * 16 + lane)] =
              tau < 14 ? std::exp(-tau) * sigma : 0;
        }
      }
    }
  return tiles;
}

} // namespace vdbeam::benchmarks
