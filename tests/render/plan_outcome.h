#pragma once

#include "support/test_frame.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace vdbeam::test {

using Stages = std::set<Stage>;

/// What a scene needs and what one pass of it did.
struct Outcome {
  Stages needed;
  RenderPlan plan;
  RenderStatistics statistics;
  PassImage image;
};

inline Outcome run(const MemoryScene& scene) {
  Outcome result;
  const TestFrame frame(scene);
  result.plan = frame.plan;
  for (const PlanStage& stage : result.plan.stages) {
    EXPECT_FALSE(stage.reason.empty()) << stage_name(stage.stage);
    if (stage.needed)
      result.needed.insert(stage.stage);
  }
  frame.estimator()->render_pass(0, result.image, result.statistics);
  return result;
}

/// Every stage that the plan leaves out has a counter of 0, and every one that it keeps ran.
inline void expect_plan_kept(const Outcome& run) {
  const RenderStatistics& s = run.statistics;
  const auto expect = [&](Stage stage, std::uint64_t count) {
    if (run.plan.needs(stage))
      EXPECT_GT(count, 0u) << stage_name(stage) << " was planned";
    else
      EXPECT_EQ(count, 0u) << stage_name(stage) << " was left out";
  };
  expect(Stage::photons, s.light_paths);
  expect(Stage::map, s.photons_stored);
  expect(Stage::map, s.bytes_per_photon);
  expect(Stage::map, s.lookups);
  expect(Stage::map, s.contributions);
  expect(Stage::photon_importance, s.importance_rays);
  expect(Stage::neighbours, s.neighbourhoods);
  expect(Stage::photon_directions, s.directions);
  expect(Stage::depth_profiles, s.depth_profiles);
  expect(Stage::emission, s.emission_rays);
  expect(Stage::shadow_rays, s.shadow_rays);
  expect(Stage::paths, s.camera_walks);
}

/// A sunlit box.
inline MemoryScene base() {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box(Vec3d(-0.5), Vec3d(0.5));
  volume.extinction = 2;
  volume.albedo = Rgb(0.9f);
  volume.phase = henyey_greenstein(0.5);
  scene.add_light(LightType::distant);
  scene.look({0, 0, 3}, {0, 0, 0}, 12, 8, 8);
  scene.scene.render.photons = 2000;
  return scene;
}

} // namespace vdbeam::test
