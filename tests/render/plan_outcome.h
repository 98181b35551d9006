#pragma once

#include "estimators/camera_ray.h"
#include "estimators/estimator.h"
#include "render/plan.h"
#include "support/memory_scene.h"
#include "transport/camera.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace vdbeam::test {

using Names = std::set<std::string>;

/// What a scene needs and what one pass of it did.
struct Outcome {
  Names needed;
  RenderPlan plan;
  RenderStatistics statistics;
  PassImage image;
};

inline Outcome run(const MemoryScene& scene) {
  Outcome result;
  const World world = scene.world();
  const Camera camera(scene.scene.camera, scene.scene.image, world.space);
  std::vector<VolumeFacts> facts;
  for (std::size_t i = 0; i < world.active_voxels.size(); ++i) {
    const std::uint64_t voxels = world.active_voxels[i];
    facts.push_back({voxels == 0, voxels, may_see_medium(world, camera), world.glowing_voxels[i]});
  }
  result.plan = plan_stages(scene.scene, facts);
  for (const PlanStage& stage : result.plan.stages) {
    EXPECT_FALSE(stage.reason.empty()) << stage.name;
    if (stage.needed)
      result.needed.insert(stage.name);
  }
  make_estimator(scene.scene.render.estimator, {world, camera, 1})
      ->render_pass(0, result.image, result.statistics);
  return result;
}

/// Every stage that the plan leaves out has a counter of 0, and every one that it keeps ran.
inline void expect_plan_kept(const Outcome& run) {
  const RenderStatistics& s = run.statistics;
  const auto expect = [&](const char* stage, std::uint64_t count) {
    if (run.plan.needs(stage))
      EXPECT_GT(count, 0u) << stage << " was planned";
    else
      EXPECT_EQ(count, 0u) << stage << " was left out";
  };
  expect("photons", s.light_paths);
  expect("map", s.photons_stored);
  expect("map", s.bytes_per_photon);
  expect("map", s.lookups);
  expect("map", s.contributions);
  expect("photon importance", s.importance_rays);
  expect("neighbours", s.neighbourhoods);
  expect("photon directions", s.directions);
  expect("depth profiles", s.depth_profiles);
  expect("emission", s.emission_rays);
  expect("shadow rays", s.shadow_rays);
  expect("paths", s.camera_walks);
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
