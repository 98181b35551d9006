#include "photons/kernel_support.h"

#include "math/sampling.h"

namespace vdbeam {

namespace {

/// Two rings of six, at the quartiles of the biweight disc's weight: 1 - (1 - s)^3 = 1/4 and 3/4.
constexpr float ring_radii[2] = {0.302f, 0.608f};
constexpr float cos_sixth[6] = {1, 0.5f, -0.5f, -1, -0.5f, 0.5f};
constexpr float sin_sixth[6] = {0, 0.866025f, 0.866025f, 0, -0.866025f, -0.866025f};

} // namespace

bool KernelSupport::inside(const Vec3f& point) const {
  bool found = false;
  medium_->for_each_at(
      point, [&](std::size_t v) { found = found || medium_->volumes[v].majorant(point) > 0; });
  return found;
}

float KernelSupport::disc_share(const Vec3f& photon, float radius) const {
  const Vec3f view(camera_->direction_towards(Vec3d(photon)));
  Vec3f u, v;
  orthonormal_frame(view, u, v);
  int hits = 0;
  for (int ring = 0; ring < 2; ++ring)
    for (int i = 0; i < 6; ++i) {
      // The outer ring is turned by a quarter of the plane's symmetry, so that twelve directions
      // count.
      const float c = ring == 0 ? cos_sixth[i] : sin_sixth[i];
      const float s = ring == 0 ? sin_sixth[i] : cos_sixth[i];
      hits += inside(photon + (u * c + v * s) * (radius * ring_radii[ring]));
    }
  return std::max(least_share, static_cast<float>(hits) / 12);
}

float KernelSupport::ball_share(const Vec3f& photon, float radius) const {
  // Faces and corners of a cube, at the root mean square distance of the biweight ball, r /
  // sqrt(3).
  const float face = 0.577f * radius, corner = 0.333f * radius;
  int hits = 0;
  for (int a = 0; a < 3; ++a)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f offset;
      offset[a] = sign * face;
      hits += inside(photon + offset);
    }
  for (int i = 0; i < 8; ++i)
    hits += inside(photon + Vec3f{i & 1 ? corner : -corner, i & 2 ? corner : -corner,
                                  i & 4 ? corner : -corner});
  return std::max(least_share, static_cast<float>(hits) / 14);
}

void clear_of_surfaces(const World& world, PhotonMap& map) {
  if (const Surfaces* surfaces = world.surfaces.get())
    map.keep_clear([&](const Vec3f& point, float most) {
      return static_cast<float>(surfaces->set->distance(Vec3d(point), static_cast<double>(most)));
    });
}

void fit_kernels(const World& world, const KernelShare& share, PhotonMap& map) {
  clear_of_surfaces(world, map);
  map.divide_power(share);
}

KernelShare boundary_share(const EstimatorInput& input, KernelDomain domain) {
  const KernelSupport support(input.world.medium, input.camera);
  if (domain == KernelDomain::ball)
    return
        [support](const Vec3f& photon, float radius) { return support.ball_share(photon, radius); };
  return
      [support](const Vec3f& photon, float radius) { return support.disc_share(photon, radius); };
}

} // namespace vdbeam
