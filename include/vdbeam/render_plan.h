#pragma once

#include "vdbeam/pass_spec.h"
#include "vdbeam/plan_choices.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace vdbeam {

/// Stages of a render (docs/developer/architecture.md).
enum class Stage {
  read,
  majorants,
  surfaces,
  photons,
  photon_importance,
  kernel_pilot,
  surface_photons,
  map,
  neighbours,
  photon_directions,
  photon_color,
  spectral_tracking,
  depth_profiles,
  emission,
  shadow_rays,
  beam_query,
  march,
  paths,
  bias,
  environment,
  moments,
  deep
};
inline constexpr std::size_t stage_count = 22;

/// Name of a stage in plans and reports, e.g. "photon importance".
constexpr std::string_view stage_name(Stage stage) {
  constexpr std::array<std::string_view, stage_count> names{"read",
                                                            "majorants",
                                                            "surfaces",
                                                            "photons",
                                                            "photon importance",
                                                            "kernel pilot",
                                                            "surface photons",
                                                            "map",
                                                            "neighbours",
                                                            "photon directions",
                                                            "photon colour",
                                                            "spectral tracking",
                                                            "depth profiles",
                                                            "emission",
                                                            "shadow rays",
                                                            "beam query",
                                                            "march",
                                                            "paths",
                                                            "bias",
                                                            "environment",
                                                            "moments",
                                                            "deep"};
  return names[static_cast<std::size_t>(stage)];
}

/// A set of stages.
class StageSet {
public:
  constexpr StageSet() = default;
  constexpr StageSet(std::initializer_list<Stage> stages) {
    for (const Stage stage : stages)
      bits_ |= bit(stage);
  }
  constexpr bool contains(Stage stage) const { return (bits_ & bit(stage)) != 0; }

private:
  static constexpr std::uint32_t bit(Stage stage) {
    return std::uint32_t{1} << static_cast<unsigned>(stage);
  }
  std::uint32_t bits_ = 0;
};

/// Whether a stage runs, and why or why not.
struct PlanStage {
  Stage stage;
  bool needed = false;
  std::string reason; ///< one clause
};

/// A mesh or texture of a scene, as found before rendering.
struct SurfaceFile {
  std::string path;
  std::uint64_t triangles = 0; ///< of a mesh
  int width = 0, height = 0;   ///< of a texture
  std::uint64_t bytes = 0;     ///< estimated peak memory while it is read
};

/// Decisions about a render before its first pass, as a value. Estimators follow it.
struct RenderPlan {
  /// Name of the estimator that renders; "auto" if it is not known before the volumes are read.
  std::string_view estimator;
  std::string choice;            ///< why it was chosen, one clause; empty where the scene names it
  std::vector<PlanStage> stages; ///< all of them, in the order of Stage
  /// All features with the choices made once the volumes were read; empty before.
  std::vector<FeatureChoice> features;
  /// The numbers of the passes, with their origin; empty before the volumes are read.
  std::vector<PlanNumber> numbers;
  /// Specifications of the passes at which something may change, up to the last pass; empty before
  /// the volumes are read.
  std::vector<PassSpec> schedule;
  /// Per light of the scene: whether shadow rays sample its single scattering. Light of the others
  /// is carried by photons, or found by scattered rays that leave the scene.
  std::vector<bool> shadow_ray_lights;
  /// Whether the mean of the passes has no bias; otherwise its bias vanishes only in the limit.
  bool unbiased = false;
  std::size_t motion_samples = 0; ///< of an open shutter; 0: nothing moves
  /// Estimated memory of these parts [bytes]; MemoryPlan has that of a whole frame.
  std::uint64_t photon_bytes = 0, film_bytes = 0;
  /// Peak memory of meshes while they are read, and of textures.
  std::uint64_t surface_bytes = 0;
  std::vector<SurfaceFile> surface_files; ///< each once; only make_plan looks for them
  std::uint64_t deep_bytes = 0; ///< of a deep image's samples: a third of their greatest number

  bool needs(Stage stage) const {
    for (const PlanStage& s : stages)
      if (s.stage == stage)
        return s.needed;
    return false;
  }
};

} // namespace vdbeam
