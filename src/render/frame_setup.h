#pragma once

#include "camera/camera.h"
#include "choose/choices.h"
#include "plan/plan.h"
#include "prepare/prepared_scene.h"
#include "rays/estimator_input.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// Input of the estimators of a frame: camera, plans, layers and objects. Members refer to
/// one another, to the scene and to what was prepared, which must outlive this.
class FrameSetup {
public:
  /// `window`: pixels that are wanted, counted from the corner of the overscan.
  FrameSetup(const Scene& scene, const PreparedScenePtr& prepared, const PixelRegion& window);
  FrameSetup(const FrameSetup&) = delete;

  const World& world() const { return *prepared_->world; }
  /// The input of the path estimator, which has a plan of its own.
  EstimatorInput path_input() const { return input.with(path_plan); }
  /// At which pixels passes are to measure how much their kernels blur, where the plan asks for the
  /// bias; `probes`: pixels whose bias is estimated.
  void probe_blur(const std::vector<std::size_t>& probes);

private:
  RenderPlan with_sizes(RenderPlan plan) const;

  const Scene& scene_;
  PreparedScenePtr prepared_;
  PixelRegion window_;
  std::vector<std::size_t> blur_pixels_;
  SceneObjects objects_;

public:
  const Camera camera;

private:
  std::vector<VolumeFacts> volumes_;

public:
  RenderPlan plan, path_plan;
  RayLayers layers;
  EstimatorInput input;
};

/// Puts into the plan what was chosen for an estimator: features, schedule and numbers.
void describe_choices(const EstimatorInput& input, const EstimatorType& type,
                      const Choices& choices, RenderPlan& plan);

} // namespace vdbeam
