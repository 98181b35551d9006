#pragma once

#include "image/pass_image.h"
#include "layers/ray_layers.h"
#include "layers/scene_objects.h"
#include "math/stop_token.h"
#include "transport/world.h"
#include "vdbeam/render.h"

#include <vector>

namespace vdbeam {

class PhotonCache;
struct SceneChoices;

/// Input of an estimator beyond the scene; objects pointed to must outlive it.
struct EstimatorTask {
  std::uint64_t frame = 1;
  /// Pixels that are wanted; empty: all. Others may stay black.
  PixelRegion window = {};
  const StopToken* stop = nullptr; ///< asks to abandon the pass
  PhotonCache* photons = nullptr;  ///< of frames with the same world; null: photons are not kept
  /// Pixels, in ascending order, where a pass is also to measure how much its kernels blur
  /// (PassImage::blur); null: nowhere.
  const std::vector<std::size_t>* blur_pixels = nullptr;
  const DeepLayout* deep = nullptr;      ///< where rays are cut for a deep picture; null: nowhere
  const SceneObjects* objects = nullptr; ///< whose coverage is asked for; null: of none
  const RayLayers* layers = nullptr;     ///< beyond the usual ones; null: none
  /// For a motion sample: the choices of the scene itself, which it follows; null: it makes its
  /// own.
  const SceneChoices* of_scene = nullptr;
  /// Light paths reach the limit of bounces often enough to be seen, where there is one.
  bool reaches_bounce_limit = true;
  /// Hears before each step of a pass; null: nobody does.
  const std::function<void(RenderStep)>* on_step = nullptr;

  void begin_step(RenderStep step) const {
    if (on_step)
      (*on_step)(step);
  }
};

/// Input of every estimator; the references must outlive it.
struct EstimatorInput : EstimatorTask {
  EstimatorInput(const World& world_, const Camera& camera_, const RenderSettings& settings_,
                 const RenderPlan& plan_, const EstimatorTask& task = {})
      : EstimatorTask(task), world(world_), camera(camera_), settings(settings_), plan(plan_) {}

  const World& world;
  const Camera& camera;
  const RenderSettings& settings;
  const RenderPlan& plan; ///< which stages run; no estimator decides that again

  /// The same in another world, which must outlive the result too.
  EstimatorInput in(const World& other) const { return {other, camera, settings, plan, *this}; }
  /// The same with the plan of another estimator, which must outlive the result too.
  EstimatorInput with(const RenderPlan& other) const {
    return {world, camera, settings, other, *this};
  }

  /// Per light of the world: single scattering is found by shadow rays. No shadow ray looks for a
  /// volume that glows; such lights come after those of the scene.
  std::vector<bool> shadow_ray_lights() const {
    std::vector<bool> lights = plan.shadow_ray_lights;
    lights.resize(world.lights.size(), false);
    return lights;
  }
  /// Channels of the photons' power.
  int photon_channels() const { return plan.needs(Stage::photon_color) ? 3 : 1; }
  std::size_t object_count() const { return objects ? objects->names.size() : 0; }
  std::size_t plane_count() const { return layers ? layers->planes() : 0; }
  /// Makes room for a pass in `image`.
  void resize(PassImage& image) const {
    image.resize(camera.width(), camera.height(), !world.medium.emitters.empty(),
                 world.lights.group_count(), deep, object_count(), plane_count());
  }
  bool stopped() const { return stop && stop->stopped(); }
  /// Throws Stopped where `stop` says so.
  void check_stop() const {
    if (stop)
      stop->check();
  }
};

} // namespace vdbeam
