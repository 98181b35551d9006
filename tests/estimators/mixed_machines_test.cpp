#include "keys/scene_enums.h"
#include "photonmap/map_queries.h"
#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

#include <bit>

// A farm has machines of several ages. Those with fused multiply-add (AVX2 and later) render the
// same bits, so frames, checkpoints and parts of frames from all of them belong together.
namespace vdbeam {
namespace {

using test::MemoryScene;

double plain_blobs(int i, int j, int k) {
  const double x = i / 24.0, y = j / 24.0, z = k / 24.0;
  return 64 * x * (1 - x) * y * (1 - y) * z * (1 - z) *
         (1 + std::sin(9 * x) * std::cos(7 * y + 1) * std::sin(8 * z + 2));
}

/// A cloud under a sun and a sky, kernels chosen by the pilot.
MemoryScene cloud() {
  MemoryScene scene;
  const Vec3<int> cells{3, 3, 3};
  VolumeSettings& volume = scene.add(test::closed_field(cells, plain_blobs),
                                     test::box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 8;
  volume.albedo = Rgb(0.9f);
  scene.look({0.5, 0.6, 2.5}, {0, 0, 0}, 24, 32, 32);
  scene.scene.render.photons = 3000;
  scene.add_light(LightType::distant).direction = {1, -0.6, -0.2};
  scene.add_light(LightType::environment).radiance = Rgb(0.3f, 0.4f, 0.6f);
  return scene;
}

MemoryScene forward() {
  MemoryScene scene = cloud();
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.85);
  return scene;
}

/// Rays of a sub-tile that share neither knots nor phase.
MemoryScene wide_angle() {
  MemoryScene scene = forward();
  scene.look({0.1, 0.2, 0.3}, {0, 0, 0}, 120, 32, 32);
  return scene;
}

MemoryScene droplets() {
  MemoryScene scene = cloud();
  scene.scene.volumes[0].phase.type = PhaseType::mie;
  return scene;
}

MemoryScene chromatic() {
  MemoryScene scene = forward();
  scene.scene.volumes[0].extinction_scale = Rgb(0.6f, 0.8f, 1.0f);
  return scene;
}

MemoryScene paper() {
  MemoryScene scene = forward();
  scene.scene.render.store = PhotonStore::scatter;
  return scene;
}

MemoryScene two_volumes() {
  MemoryScene scene = forward();
  VolumeSettings& fog = scene.add_box(Vec3d(-0.7, -0.7, -0.2), Vec3d(0.7, -0.1, 0.7));
  fog.extinction = 2;
  fog.albedo = Rgb(0.5f, 0.7f, 0.9f);
  return scene;
}

struct SceneCase {
  const char* name;
  MemoryScene (*make)();
};

/// The bits of all pixels of two passes.
std::vector<std::uint32_t> image_bits(const MemoryScene& scene) {
  const test::TestFrame frame(scene);
  const auto estimator = frame.estimator();
  PassImage image;
  RenderStatistics statistics;
  std::vector<std::uint32_t> bits;
  for (int pass = 0; pass < 2; ++pass) {
    estimator->render_pass(pass, image, statistics);
    for (const auto* layer : {&image.direct, &image.indirect, &image.background})
      for (const Rgb& value : *layer)
        for (int c = 0; c < 3; ++c)
          bits.push_back(std::bit_cast<std::uint32_t>(value[c]));
    for (const auto* layer : {&image.opacity, &image.depth})
      for (const float value : *layer)
        bits.push_back(std::bit_cast<std::uint32_t>(value));
  }
  return bits;
}

/// The SIMD targets of this machine on which bits must agree.
std::vector<std::int64_t> fused_targets() {
  std::vector<std::int64_t> targets;
  for (const std::int64_t target : simd_targets()) {
    confine_simd_targets(target);
    if (simd_is_fused())
      targets.push_back(target);
  }
  confine_simd_targets(0);
  return targets;
}

class MixedMachines : public testing::TestWithParam<std::tuple<EstimatorType, SceneCase>> {
protected:
  void SetUp() override {
    if (fused_targets().size() < 2)
      GTEST_SKIP() << "this machine has one SIMD target with fused multiply-add only";
  }
  void TearDown() override { confine_simd_targets(0); }
};

TEST_P(MixedMachines, RenderTheSameBits) {
  MemoryScene scene = std::get<1>(GetParam()).make();
  scene.scene.render.estimator = std::get<0>(GetParam());
  std::vector<std::uint32_t> first;
  for (const std::int64_t target : fused_targets()) {
    confine_simd_targets(target);
    SCOPED_TRACE(simd_target());
    const std::vector<std::uint32_t> bits = image_bits(scene);
    if (first.empty())
      first = bits;
    std::size_t different = 0;
    for (std::size_t i = 0; i < bits.size(); ++i)
      different += bits[i] != first[i];
    EXPECT_EQ(different, 0u) << "of " << bits.size();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MixedMachines,
    testing::Combine(testing::Values(EstimatorType::beam, EstimatorType::march),
                     testing::Values(SceneCase{"isotropic", cloud}, SceneCase{"forward", forward},
                                     SceneCase{"wide_angle", wide_angle},
                                     SceneCase{"droplets", droplets},
                                     SceneCase{"chromatic", chromatic}, SceneCase{"paper", paper},
                                     SceneCase{"two_volumes", two_volumes})),
    [](const auto& test) {
      return std::string(std::get<0>(test.param).name) + "_" + std::get<1>(test.param).name;
    });

} // namespace
} // namespace vdbeam
