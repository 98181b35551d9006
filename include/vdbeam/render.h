#pragma once

#include "vdbeam/image.h"
#include "vdbeam/scene.h"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace vdbeam {

/// One finished pass, as the report lists it.
struct PassRecord {
  int pass = 0;              ///< number of passes so far
  double seconds = 0;        ///< since rendering began (reading excluded)
  std::uint64_t photons = 0; ///< stored in this pass
  double error_estimate = 0; ///< MRSE of the image so far, from the spread of the passes
  double rmse = 0, mrse = 0, relmse = 0, bias = 0; ///< against the reference, where one is given
  bool has_reference = false;
};

/// Seconds and counts of a render, by stage.
struct RenderStatistics {
  double read = 0, build = 0, trace = 0, order = 0, radii = 0, query = 0, profile = 0, direct = 0,
         path = 0, write = 0;
  std::uint64_t light_paths = 0, photons_stored = 0, contributions = 0, lookups = 0,
                camera_rays = 0;
  std::uint64_t peak_memory = 0; ///< bytes, whole process
  std::size_t bytes_per_photon = 0;
};

/// What a stage of the render plan is and why it runs or is left out.
struct PlanStage {
  std::string name;   ///< "read", "photons", "map", "neighbours", "direct", ...
  bool needed = false;
  std::string reason; ///< one clause
};

/// The stages that a scene needs, as a value (docs/architecture.md).
struct RenderPlan {
  std::vector<PlanStage> stages;
  std::uint64_t volume_bytes = 0, photon_bytes = 0, film_bytes = 0; ///< estimates

  bool needs(const std::string& stage) const {
    for (const PlanStage& s : stages)
      if (s.name == stage)
        return s.needed;
    return false;
  }
};

/// Everything a render gives back.
struct RenderResult {
  Image image;                    ///< R, G, B, A and the AOVs
  std::vector<PassRecord> passes;
  RenderStatistics statistics;
  RenderPlan plan;
  std::vector<std::string> notes; ///< for the user: repairs, empty grids, choices made
  std::string stopped_by;         ///< "passes", "time", "target_error", "stop"
};

/// Hooks of the caller; all optional.
struct RenderHooks {
  /// After each pass, on the rendering thread.
  std::function<void(const PassRecord&, const RenderStatistics&)> on_pass;
  /// A line for the user, as soon as it is known.
  std::function<void(const std::string&)> on_note;
  /// Ends the render after the pass in progress when it becomes true.
  const std::atomic<bool>* stop = nullptr;
  /// The true image (R, G, B), for errors in the pass records; same size as the scene's.
  const Image* reference = nullptr;
  int frame = 1; ///< keys the random numbers
};

/// Renders one frame. Throws InputError and FrameError.
RenderResult render(const Scene& scene, const RenderHooks& hooks = {});

/// The plan alone, from the scene and the grids' headers; reads no voxels.
RenderPlan make_plan(const Scene& scene);

} // namespace vdbeam
