#include "laws/adding_doubling.h"
#include "laws/slab_tables.h"
#include "medium/scattering.h"
#include "support/memory_scene.h"
#include "support/next_scattering.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

// Plane-parallel slabs, made of a flat box that is so wide that nothing leaves by its sides: what
// the renderer's walks reflect and transmit, against published tables and adding-doubling.
namespace vdbeam {
namespace {

using test::MemoryScene;

/// Optical half width of the slabs: exp(-16) of a ray along the slab gets to the side.
constexpr double half_width = 16;

struct SlabSpec {
  double thickness; ///< optical
  float albedo;
  PhaseSettings phase;
  double mu0; ///< cosine of incidence
};

PhaseSettings isotropic() {
  return {};
}
PhaseSettings rayleigh() {
  PhaseSettings phase;
  phase.type = PhaseType::rayleigh;
  return phase;
}

/// The slab fills -1/2 < z < 1/2; light comes from above.
MemoryScene slab_scene(const SlabSpec& spec, double least_half_width = 100) {
  const double half = std::max(half_width / spec.thickness, least_half_width);
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box({-half, -half, -0.5}, {half, half, 0.5});
  volume.extinction = spec.thickness;
  volume.albedo = Rgb(spec.albedo);
  volume.phase = spec.phase;
  return scene;
}

Vec3f incidence(double mu0) {
  return {static_cast<float>(std::sqrt(1 - mu0 * mu0)), 0, static_cast<float>(-mu0)};
}

struct Escapes {
  std::uint64_t up = 0, down = 0, sideways = 0;
};

/// One photon through the slab, by the library's own free flights, roulette and phase functions.
void walk(const World& world, Ray ray, Rng& rng, Escapes& escapes) {
  Rgb weight(1);
  while (true) {
    const Collision hit = test::next_scattering(world.medium, ray, weight, rng);
    if (hit.volume == nullptr) {
      const float z =
          ray.direction.z > 0 ? world.medium.bounds.upper.z : world.medium.bounds.lower.z;
      const Vec3f exit = ray.at((z - ray.origin.z) / ray.direction.z);
      const float side = world.medium.bounds.upper.x;
      if (std::abs(exit.x) > side || std::abs(exit.y) > side)
        ++escapes.sideways;
      else
        ++(ray.direction.z > 0 ? escapes.up : escapes.down);
      return;
    }
    if (!absorption_roulette(hit.volume->albedo, weight, rng))
      return;
    const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    const PhaseFunction& phase = world.medium.phases[hit.volume->phase_index];
    ray = {ray.at(hit.t), phase.sample(ray.direction, u_lobe, u, v)};
  }
}

/// Shares of `count` walks that leave above and below.
Escapes walk_many(const World& world, const Vec3f& direction, std::uint64_t count) {
  const float top = static_cast<float>(0.5 * world.space.scale);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::uint64_t>(0, count, 1000), Escapes{},
      [&](const tbb::blocked_range<std::uint64_t>& range, Escapes escapes) {
        for (std::uint64_t n = range.begin(); n < range.end(); ++n) {
          Rng rng({1, 0, 0}, RngStage::test, n);
          walk(world, {Vec3f(0, 0, top) - direction * (0.1f * top), direction}, rng, escapes);
        }
        return escapes;
      },
      [](const Escapes& a, const Escapes& b) {
        return Escapes{a.up + b.up, a.down + b.down, a.sideways + b.sideways};
      });
}

void expect_share(std::uint64_t hits, std::uint64_t count, double expected) {
  const double n = static_cast<double>(count), share = static_cast<double>(hits) / n;
  const double error = std::sqrt(std::max(expected * (1 - expected), 1 / n) / n);
  EXPECT_LE(std::abs(share - expected), 4 * error + 1e-6)
      << share << ", expected " << expected << " +- " << error;
}

void expect_slab(const SlabSpec& spec, double reflectance, double transmittance,
                 std::uint64_t count) {
  SCOPED_TRACE(testing::Message() << "thickness " << spec.thickness << " albedo " << spec.albedo
                                  << " mu0 " << spec.mu0);
  const World world = slab_scene(spec).world();
  const Escapes escapes = walk_many(world, incidence(spec.mu0), count);
  expect_share(escapes.up, count, reflectance);
  expect_share(escapes.down, count, transmittance);
  EXPECT_LE(static_cast<double>(escapes.sideways), 1e-5 * static_cast<double>(count));
}

/// Every published slab with a beam. The tables' digits are good to 1e-5, far below the noise.
void expect_published(std::uint64_t count) {
  constexpr double pi = std::numbers::pi;
  for (const slab::IsotropicSlab& table : slab::isotropic_slabs)
    if (table.beam) {
      // The tables give diffuse light alone, for a flux of pi on the slab.
      const double direct = std::exp(-table.thickness / 0.1);
      expect_slab({table.thickness, static_cast<float>(table.albedo), isotropic(), 0.1},
                  table.up / pi, table.down / pi + direct, count);
    }
  for (const slab::RayleighSlab& table : slab::rayleigh_slabs) {
    const double flux = pi * slab::rayleigh_mu0;
    const double direct = std::exp(-table.thickness / slab::rayleigh_mu0);
    expect_slab({table.thickness, static_cast<float>(table.albedo), rayleigh(), slab::rayleigh_mu0},
                table.up / flux, table.down / flux + direct, count);
  }
  for (const slab::HenyeyGreensteinSlab& table : slab::henyey_greenstein_slabs)
    expect_slab({table.thickness, 1, test::henyey_greenstein(0.75), 1}, table.up / pi,
                table.down / pi + std::exp(-table.thickness), count);
  expect_slab({2, 0.9f, test::henyey_greenstein(0.75), 1}, slab::tissue_reflectance,
              slab::tissue_transmittance, count);
}

TEST(Slab, PublishedReflectanceAndTransmittance) {
  expect_published(100000);
}

// Four standard errors are at most 2e-3 of what comes in.
TEST(SlowSlab, PublishedReflectanceAndTransmittanceToMoreDigits) {
  expect_published(1000000);
}

TEST(Slab, AddingDoublingOfOtherSlabs) {
  for (const double g : {-0.5, 0.4, 0.8})
    for (const float albedo : {0.5f, 0.95f}) {
      const double mu0 = 0.6;
      const slab::Slab exact(slab::henyey_greenstein(g), static_cast<double>(albedo), 3, {mu0});
      expect_slab({3, albedo, test::henyey_greenstein(g), mu0}, exact.reflectance(),
                  exact.transmittance(), 100000);
    }
}

// What a camera sees of a slab under the sun at the zenith, at some angles, from above and from
// below.
struct SlabView {
  double mu;
  bool below;
};

MemoryScene seen_slab(const SlabSpec& spec, const SlabView& view, double least_half_width = 100) {
  MemoryScene scene = slab_scene(spec, least_half_width);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0, 0, -1};
  const double sine = std::sqrt(1 - view.mu * view.mu), side = view.below ? -1 : 1;
  const Vec3d target{0, 0, side * 0.5};
  scene.look(target + Vec3d{0, sine, side * view.mu} * 5.0, target, 0.1, 8, 8);
  return scene;
}

void expect_seen(const SlabSpec& spec, const slab::Moments& moments, EstimatorType estimator,
                 int passes, double bias, std::size_t points = 32) {
  const std::vector<double> angles{0.2, 0.5, 0.9};
  const slab::Slab exact(moments, static_cast<double>(spec.albedo), spec.thickness, {1}, angles,
                         points);
  for (std::size_t i = 0; i < angles.size(); ++i)
    for (const bool below : {false, true}) {
      SCOPED_TRACE(testing::Message() << "mu " << angles[i] << (below ? " below" : " above"));
      const double expected = below ? exact.transmitted_radiance(i) : exact.reflected_radiance(i);
      MemoryScene scene = seen_slab(spec, {angles[i], below});
      const test::PassMeans means = test::render_passes(scene, estimator, passes);
      test::expect_mean(means.total[0], expected, bias * expected, 1e-5);
      EXPECT_LT(means.total[0].error(), 0.02 * expected);
    }
}

TEST(Slab, RadianceByPaths) {
  expect_seen({1, 1, isotropic(), 1}, slab::isotropic(), EstimatorType::path, 150, 0);
  expect_seen({4, 0.9f, test::henyey_greenstein(0.75), 1}, slab::henyey_greenstein(0.75),
              EstimatorType::path, 150, 0);
}

TEST(Slab, RadianceByPathsThatBranchTowardsTheSun) {
  expect_seen({4, 0.9f, test::henyey_greenstein(0.93), 1}, slab::henyey_greenstein(0.93),
              EstimatorType::path, 120, 0, 96);
}

/// A slab as beam renders it by default: the kernels are those that its pilot chooses, a mean free
/// path wide or more, the forward peak is taken out.
struct BeamSlab {
  std::string name;
  double thickness;
  float albedo;
  double g;
  /// Bias of the kernels, in parts of the radiance, where the slab is seen at mu = 0.3 and at 0.9.
  /// Aslant, kernels wider than a mean free path reach out of the slab and blur the skin's
  /// gradient.
  double aslant, steep;
  double noise = 0.02; ///< standard errors stay below this share of the radiance
};

class SlowSlabRadiance : public testing::TestWithParam<BeamSlab> {};

TEST_P(SlowSlabRadiance, ByBeam) {
  const BeamSlab& slab = GetParam();
  const std::vector<double> angles{0.3, 0.9};
  constexpr double half = 6; // of the slab's width, in its thicknesses
  // Moments beyond twice the points are cut: 0.95^256 = 2e-6.
  const slab::Slab exact(slab::henyey_greenstein(slab.g), static_cast<double>(slab.albedo),
                         slab.thickness, {1}, angles, 128);
  for (std::size_t i = 0; i < angles.size(); ++i)
    for (const bool below : {false, true}) {
      SCOPED_TRACE(testing::Message() << "mu " << angles[i] << (below ? " below" : " above"));
      const double expected = below ? exact.transmitted_radiance(i) : exact.reflected_radiance(i);
      const SlabSpec spec{slab.thickness, slab.albedo, test::henyey_greenstein(slab.g), 1};
      MemoryScene scene = seen_slab(spec, {angles[i], below}, half);
      // From far away a part 2 wide, well inside of the slab, at one angle.
      CameraSettings& camera = scene.scene.camera;
      camera.position = camera.look_at + (camera.position - camera.look_at) * 100.0;
      camera.fov = 0.23;
      scene.scene.render.photons = 60000;
      const test::PassMeans means = test::render_passes(scene, EstimatorType::beam, 48);
      // Volume of the box times the fraction of its photons in a kernel.
      const double kernel = 4 * half * half * 48 * means.statistics.neighbours /
                            static_cast<double>(means.statistics.photons_stored);
      const double radius = std::cbrt(kernel * 3 / (4 * std::numbers::pi));
      EXPECT_GT(radius * slab.thickness, 0.9); // mean free paths
      test::expect_mean(means.total[0], expected, (i == 0 ? slab.aslant : slab.steep) * expected);
      test::expect_power(means.total[0], slab.noise * expected);
    }
}

INSTANTIATE_TEST_SUITE_P(Slabs, SlowSlabRadiance,
                         testing::Values(BeamSlab{"Isotropic", 4, 1, 0, 0.04, 0.02},
                                         BeamSlab{"Forward", 4, 0.9f, 0.75, 0.09, 0.03},
                                         BeamSlab{"MoreForward", 8, 1, 0.9, 0.17, 0.08},
                                         BeamSlab{"MostForward", 8, 0.99f, 0.95, 0.12, 0.08, 0.05}),
                         [](const auto& slab) { return slab.param.name; });

} // namespace
} // namespace vdbeam
