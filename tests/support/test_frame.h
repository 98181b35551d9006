#pragma once

#include "camera/camera.h"
#include "choose/pass_renderer.h"
#include "plan/plan.h"
#include "support/memory_scene.h"

namespace vdbeam::test {

/// A frame of a scene, ready for estimators, which refer to it.
class TestFrame {
public:
  explicit TestFrame(const MemoryScene& scene)
      : settings(scene.scene.render), world(scene.world(&facts_)),
        camera(scene.scene.camera, scene.scene.image, world.space),
        plan(plan_stages(scene.scene, volume_facts(facts_, world, camera))) {}
  TestFrame(const TestFrame&) = delete;

  EstimatorInput input(std::uint64_t frame = 1) const {
    return {world, camera, settings, plan, {frame}};
  }
  std::unique_ptr<PassRenderer> estimator(std::uint64_t frame = 1) const {
    return make_pass_renderer(settings.estimator, input(frame));
  }

private:
  WorldFacts facts_;

public:
  const RenderSettings settings;
  const World world;
  const Camera camera;
  const RenderPlan plan;
};

} // namespace vdbeam::test
