// Shadow rays are sent where a lattice of optical depths expects the light.
#include "rays/direct_light.h"

#include "medium/optical_depth.h"
#include "support/render_passes.h"
#include "transport/camera_ray.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

MemoryScene lumps(double depth) {
  MemoryScene scene;
  const DensityField field = closed_field(
      {8, 6, 4}, [](int i, int j, int k) { return lattice_noise(i / 4, j / 4, k / 4); });
  VolumeSettings& volume =
      scene.add(field, box_map({8, 6, 4}, {-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}));
  volume.extinction = depth;
  volume.albedo = Rgb(0.9f);
  volume.phase = henyey_greenstein(0.6);
  scene.add_light(LightType::distant).direction = {0.8, -0.5, -0.2};
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 16, 16);
  return scene;
}

TEST(ShadowLattice, IsExactAtItsPointsAndNearBetween) {
  const World world = lumps(4).world();
  const Vec3f towards = *world.lights[0].narrow_direction();
  const ShadowLattice lattice(world.medium, towards, 1200);
  const Boxf& box = world.medium.bounds;
  const auto depth = [&](const Vec3f& p) {
    return -std::log(static_cast<double>(lattice.transmittance(p)));
  };
  const auto exact = [&](const Vec3f& p) {
    return -std::log(
        static_cast<double>(max_component(exact_transmittance(world.medium, {{p, towards}}))));
  };
  const Vec3<int> n = lattice.counts();
  double deepest = 0;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; z += 3) {
        const Vec3f p = lattice.point({x, y, z});
        // Within cubes the profile's pieces are straight.
        EXPECT_NEAR(depth(p), exact(p), 0.01);
        deepest = std::max(deepest, exact(p));
      }
  EXPECT_GT(deepest, 1);
  const Vec3f last = lattice.point({n.x - 1, n.y - 1, n.z - 1});
  EXPECT_EQ(lattice.transmittance(last - towards), lattice.transmittance(last));
  Rng rng({5, 1, 1}, RngStage::test, 0);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const float u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
    const Vec3f p = box.lower + box.size() * Vec3f(u, v, w);
    worst = std::max(worst, std::abs(depth(p) - exact(p)));
  }
  EXPECT_LT(worst, 0.5); // the light is off by e^0.5 at the most
}

struct Direct {
  std::array<Samples, 2> plain, guided; ///< means over the left and the right of the picture
};

/// Direct light of many draws with the lattice and without.
Direct measure(const MemoryScene& scene, double rays) {
  const World world = scene.world();
  const Camera camera(scene.scene.camera, scene.scene.image, world.space);
  const std::vector<bool> sampled(world.lights.size(), true);
  const ShadowLattices none, lattices = make_shadow_lattices(world, sampled, rays);
  Direct result;
  std::uint64_t shadow_rays = 0;
  for (std::uint64_t draw = 0; draw < 200; ++draw)
    for (const bool guided : {false, true}) {
      double sums[2] = {};
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
          const CameraRay ray = camera_ray(world, camera, camera.ray(x + 0.5, y + 0.5));
          DepthProfile profile;
          profile.build(world.medium, ray.segment, 1e-6f);
          Rng rng({3, 1, draw + (guided ? 1000 : 0)}, RngStage::direct,
                  static_cast<std::uint64_t>(16 * y + x));
          const GroupedLight light =
              direct_light(world, ray.segment.ray, profile,
                           {sampled, 2, guided ? &lattices : &none}, rng, shadow_rays);
          sums[x / 8] += static_cast<double>(light.sum().x);
        }
      for (std::size_t i : {0u, 1u})
        (guided ? result.guided : result.plain)[i].add(sums[i] / 128);
    }
  return result;
}

/// In a wide fog, which is most of the medium, the cloud in it has a lattice of its own.
TEST(ShadowLattice, IsAsFineInACloudWhereFogSurroundsIt) {
  const auto worst_in_cloud = [](const World& world) {
    const ShadowLattice lattice(world.medium, *world.lights[0].narrow_direction(), 1200);
    Rng rng({5, 1, 1}, RngStage::test, 0);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      const float u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
      const Vec3f p = Vec3f(-0.5f, -0.4f, -0.3f) + Vec3f(1, 0.8f, 0.6f) * Vec3f(u, v, w);
      const Vec3f point(world.space.point(Vec3d(p)));
      const Rgb exact =
          exact_transmittance(world.medium, {{point, *world.lights[0].narrow_direction()}});
      worst = std::max(worst, std::abs(static_cast<double>(lattice.transmittance(point)) -
                                       static_cast<double>(max_component(exact))));
    }
    return worst;
  };
  MemoryScene scene = lumps(4);
  const double alone = worst_in_cloud(scene.world());
  scene.add_box(Vec3d(-30), Vec3d(30)).extinction = 0.01;
  EXPECT_LT(worst_in_cloud(scene.world()), 1.2 * alone + 0.01);
}

TEST(ShadowLattice, LosesNothingAndLowersNoise) {
  for (const double rays : {60.0, 1000.0}) { // a coarse lattice is right on average too
    const Direct direct = measure(lumps(40), rays);
    for (std::size_t i : {0u, 1u})
      expect_same_mean(direct.guided[i], direct.plain[i]);
    EXPECT_LT(direct.guided[0].error(), 0.01 * direct.guided[0].mean());
    if (rays > 100) {
      EXPECT_LT(direct.guided[0].variance(), 0.5 * direct.plain[0].variance());
    }
  }
}

/// Two suns have a lattice each, a sky has none, and a lamp in the medium keeps its own samples.
TEST(ShadowLattice, BesideOtherLights) {
  MemoryScene scene = lumps(10);
  scene.add_light(LightType::distant).direction = {-0.3, -1, 0.2};
  scene.add_light(LightType::environment).radiance = Rgb(0.5f);
  scene.add_light(LightType::point).position = {0.1, 0.1, 0.2};
  const World world = scene.world();
  const ShadowLattices lattices = make_shadow_lattices(world, {true, true, true, true}, 100);
  EXPECT_TRUE(lattices[0] && lattices[1] && !lattices[2] && !lattices[3]);
  EXPECT_FALSE(make_shadow_lattices(world, {false, true, true, true}, 100)[0]);
  const Direct direct = measure(scene, 300);
  for (std::size_t i : {0u, 1u})
    expect_same_mean(direct.guided[i], direct.plain[i]);
}

} // namespace
} // namespace vdbeam
