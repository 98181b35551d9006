// The render plan of volumes that glow.
#include "render/plan_outcome.h"

namespace vdbeam {
namespace {

using namespace test;

/// The sunlit box without its sun, glowing.
MemoryScene ember() {
  MemoryScene scene = base();
  scene.scene.lights.clear();
  scene.glow(uniform_field({1, 1, 1}, 1), box_map({1, 1, 1}, Vec3d(-0.5), Vec3d(0.5)));
  return scene;
}

TEST(Plan, GlowingSmokeLightsItself) {
  MemoryScene scene = ember();
  const Outcome beam = run(scene);
  EXPECT_EQ(beam.needed,
            (Stages{Stage::read, Stage::majorants, Stage::photons, Stage::photon_importance,
                    Stage::kernel_pilot, Stage::map, Stage::neighbours, Stage::photon_directions,
                    Stage::depth_profiles, Stage::emission, Stage::beam_query, Stage::bias}));
  expect_plan_kept(beam);
  scene.scene.render.estimator = EstimatorType::path;
  const Outcome path = run(scene);
  EXPECT_EQ(path.needed, (Stages{Stage::read, Stage::majorants, Stage::depth_profiles,
                                 Stage::emission, Stage::paths}));
  expect_plan_kept(path);
  // The light of the medium itself is never sought by shadow rays, whatever is asked for.
  scene.scene.render.estimator = EstimatorType::beam;
  scene.scene.render.direct = DirectLight::sampled;
  expect_plan_kept(run(scene));
}

TEST(Plan, EmissionOnly) {
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    MemoryScene scene = ember();
    scene.scene.render.estimator = type;
    scene.scene.volumes[0].albedo = Rgb(0);
    const Outcome black = run(scene);
    EXPECT_EQ(black.needed,
              (Stages{Stage::read, Stage::majorants, Stage::depth_profiles, Stage::emission}));
    expect_plan_kept(black);
    scene.scene.volumes[0].extinction = 0;
    const Outcome clear = run(scene);
    EXPECT_EQ(clear.needed, (Stages{Stage::read, Stage::emission}));
    expect_plan_kept(clear);
    scene.look({0, 0, 3}, {0, 0, 6}, 12, 8, 8);
    const Outcome away = run(scene);
    EXPECT_EQ(away.needed, Stages{Stage::read});
    expect_plan_kept(away);
  }
}

TEST(Plan, GlowingSmokeOfOneBounce) {
  MemoryScene scene = ember();
  scene.scene.render.max_bounces = 1;
  const Outcome r = run(scene);
  EXPECT_TRUE(r.plan.needs(Stage::photons));
  expect_plan_kept(r);
}

/// A frame before the fire is lit.
TEST(Plan, NothingGlowsYet) {
  MemoryScene scene = base();
  scene.glow({}, {});
  const Outcome r = run(scene);
  EXPECT_EQ(r.needed, run(base()).needed);
  expect_plan_kept(r);
}

TEST(Plan, ColourOfGlowingSmoke) {
  MemoryScene scene = ember();
  EXPECT_FALSE(run(scene).plan.needs(Stage::photon_color));
  scene.scene.volumes[0].emission.color = {1, 0.5f, 0.1f};
  const Outcome r = run(scene);
  EXPECT_TRUE(r.plan.needs(Stage::photon_color));
  expect_plan_kept(r);
}

} // namespace
} // namespace vdbeam
