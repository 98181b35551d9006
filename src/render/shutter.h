#pragma once

#include "choose/pass_renderer.h"
#include "render/bias_probe.h"
#include "vdbeam/render.h"

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace vdbeam {

/// Gives each pass what renders it at its own moment of the shutter's time
/// (PassSpec::motion_sample). Where the camera alone moves all passes share one world; else worlds
/// are built when they are first needed, and kept as far as memory goes. Choices made at the
/// scene's own moment serve all of them: pilots at each would take longer than a pass.
class Shutter {
public:
  /// The renderer of a pass, valid until the next call of `at`.
  struct Renderer {
    PassRenderer& passes;
    BiasProbe* probe; ///< measures the bias; null if the estimator has none or it is not asked for
  };

  /// `type`: of the estimator that renders, `auto` for those that gather photons. `input` is that
  /// of the scene itself; `path_plan` the plan of the path estimator. All must outlive this.
  Shutter(const Scene& scene, const EstimatorType& type, const PreparedScenePtr& prepared,
          const EstimatorInput& input, const RenderPlan& path_plan,
          const std::vector<std::size_t>& probe_pixels);

  /// Has the passes of a still scene that were made already.
  void take(std::unique_ptr<PassRenderer> ready) { ready_ = std::move(ready); }
  /// Has the choices of the scene itself, which moments are to follow; adds the work that they
  /// took.
  void follow(SceneChoices choices, RenderStatistics& statistics);
  /// Adds what the estimator tries out before its first pass to statistics.pilot.
  Renderer at(int pass, RenderStatistics& statistics);

private:
  /// A world and what renders it.
  struct MomentRenderer {
    MomentRenderer(const PreparedScenePtr& prepared_, const Camera& camera_,
                   const EstimatorInput& from, const RenderPlan& path_plan);

    PreparedScenePtr prepared;
    Camera camera;
    std::optional<SceneChoices> scene_choices; ///< in this moment's units
    EstimatorInput input, path_input;
    std::optional<RayLayers> layers; ///< of this moment
    std::unique_ptr<PassRenderer> passes;
    std::unique_ptr<BiasProbe> probe;
    int last_pass = 0;
  };

  MomentRenderer& renderer_of(const Scene& moment, RenderStatistics& statistics);
  const std::optional<SceneChoices>& scene_choices(RenderStatistics& statistics);
  void make_room();

  const Scene& scene_;
  EstimatorType type_;
  PreparedScenePtr prepared_;
  const EstimatorInput& input_;
  const RenderPlan& path_plan_;
  std::optional<SceneChoices> scene_choices_; ///< that the moments follow
  const std::vector<std::size_t>& probe_pixels_;
  std::unique_ptr<PassRenderer> ready_;
  std::map<std::string, std::unique_ptr<MomentRenderer>>
      renderers_; ///< by what their worlds are made from
};

} // namespace vdbeam
