#pragma once

#include "choose/peak_orders.h"
#include "choose/pilot/gather_plan.h"
#include "photons/photon_plan.h"

namespace vdbeam {

struct KernelTrialResult;

/// Work of a pilot, as it counts it.
struct PilotWork {
  std::uint64_t light_paths = 0, camera_rays = 0;

  PilotWork operator-(const PilotWork& other) const {
    return {light_paths - other.light_paths, camera_rays - other.camera_rays};
  }
};

/// How the passes of a frame are rendered: chosen once, before the first pass, as a pure function
/// of the estimator's input (by counts, never by a clock).
struct Choices {
  std::string_view estimator;       ///< of all passes
  std::size_t motion_samples = 0;   ///< a pass renders one of them; 0: nothing moves
  bool fits_surfaces = false;       ///< the light of surfaces is fitted over pixels
  PeakOrders peak;                  ///< of phase functions, which photons live without
  PhotonPlan photons;               ///< lights, light paths, photons and kernels
  std::optional<GatherPlan> gather; ///< of final gathering; empty: there is none
  /// Work of the pilots of view importance, of the path guide and of kernels.
  PilotWork view_work, guide_work, kernel_work;
  /// Forecast error of gathering along camera rays over that of final gathering after the same
  /// time; 0: there is no forecast.
  double lead_of_gather = 0;
  /// Result of the kernel pilot; null without one.
  std::shared_ptr<const KernelTrialResult> trial;
};

/// The choices of a scene whose moments are other worlds, and where these are.
struct SceneChoices {
  Choices choices;
  RenderSpace space; ///< in which the choices are given

  /// The same where `scale` render units are one of the world. The unit of a moment is another than
  /// the scene's where its bounds have grown over a power of two.
  SceneChoices in_units(double scale) const;
};

} // namespace vdbeam
