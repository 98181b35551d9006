#pragma once

#include "math/pass_numbers.h"
#include "photonmap/photon_map.h"
#include "rays/estimator_input.h"
#include "transport/photon_tracing.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace vdbeam {

/// Plan of the photon passes of a frame: chosen once, before the first pass, as a pure
/// function of the estimator's input (by counts, never by a clock).
struct PhotonPlan {
  /// Per light: single scattering by shadow rays instead of photons.
  std::vector<bool> sampled_lights;
  /// Shadow-ray samples per camera ray, at least and at most.
  int direct_samples = 1, most_direct_samples = 1;
  bool chooses_direct_samples = false; ///< the scene asks for no number
  /// Opacity of a camera ray from which on it gets all of its walks and shadow rays.
  float full_opacity = 0;
  /// The photons' power is scattered flux already, so that rays need not multiply by the albedo:
  /// always in scatter storage, in fluence storage where all volumes have the same albedo.
  bool albedo_in_power = false;
  std::uint64_t paths = 0; ///< light paths per pass
  /// Probability with which a storable collision is stored; by cell where the tables are given.
  double store_probability = 1;
  std::shared_ptr<const CellTables> store_probability_by_cell;
  /// Where light paths begin, end and split; null: emission by power, no windows.
  std::shared_ptr<const PathGuide> guide;
  /// Camera rays of a pass that show photons' light: those that meet the medium, by their effort
  /// (effort_of), and surfaces where photons bring caustics.
  double hits = 0;
  double stored_per_path = 1;     ///< expected photons of a light path
  double neighbours = 0;          ///< photons in the sphere of an adaptive kernel's radius
  double caustic_share = 0;       ///< of photons of caustic_lights() in the power of all
  double collisions_per_path = 1; ///< of light paths as they are sent in the end
  /// Where probabilities are given by cell: they are min(1, view_factor times view_importance with
  /// the fall-off `view_reach` [render units]).
  float view_reach = 0, view_factor = 0;

  /// Shadow-ray samples of a camera ray that meets the optical depth `depth`: more where it is
  /// small and lights have an extent, since what is seen there is mostly scattered once.
  int direct_samples_of(float depth) const;
  /// Part of the effort that a camera ray of this opacity gets: thin medium beside or before a
  /// cloud, which is hardly seen, does not cost as much as the cloud.
  float effort_of(float opacity) const {
    return opacity < full_opacity ? opacity / full_opacity : 1;
  }

  /// Kernels count with the part of them that lies inside the medium.
  bool share_at_boundary = true;
  /// Shadow rays go where lights of one direction reach the medium (ShadowLattice).
  bool shadow_lattices = false;

  std::uint64_t pilot_paths = 0;     ///< light paths traced to find all this out
  std::uint64_t importance_rays = 0; ///< camera rays that found out where photons are seen
};

/// Whether shadow rays look for some light with an extent, by is_sampled(index).
template <class Predicate>
bool samples_extended_light(const World& world, const Predicate& is_sampled) {
  for (std::size_t i = 0; i < world.lights.size(); ++i)
    if (is_sampled(i) && !world.lights[i].is_delta())
      return true;
  return false;
}

/// The part of the plan that needs no pilot: the settings and the render plan's decisions.
PhotonPlan default_photon_plan(const EstimatorInput& input);
/// Traces a few light paths and chooses from the mean number of their collisions how many shadow
/// rays to send and how many photons to store, everywhere with the same probability. Only for a
/// render that needs photons. The photons hold all storable collisions.
TracedPhotons trace_pilot(const EstimatorInput& input, PhotonPlan& plan);
/// Sees what a coarse sample of the camera rays meets: `hits` and `full_opacity` of the plan.
void look_at_rays(const EstimatorInput& input, PhotonPlan& plan);
/// Light paths per pass: by the scene's number of photons or, where it asks for none, by the camera
/// rays that show their light.
std::uint64_t choose_paths(const RenderSettings& settings, const PhotonPlan& plan);
/// Where the scene asks for no number. Thin media get more, up to tuning::most_paths_in_thin_media
/// times that number.
double automatic_paths(double hits, double stored_per_path, double collisions_per_path);
/// Where the scene asks for a number of photons.
double paths_for_photons(double photons, double stored_per_path);

/// Per light of the world: shadow rays look for it from surfaces, whatever the medium's photons
/// bring, since a path from a surface may not meet it.
std::vector<bool> lights_of_surfaces(const EstimatorInput& input);

/// Per light: mirrors or smooth glass may bring its light into the medium, but rays from there meet
/// it by rare chance or never, since it comes from one point or about one direction. Empty where
/// there is none.
std::vector<bool> caustic_lights(const World& world);

/// Whether light paths reach the scene's limit of bounces: by a few of them, a thousandth of whose
/// collisions at least lie beyond it.
bool reach_bounce_limit(const EstimatorInput& input);

/// How photons of a pass are traced and stored.
PhotonPassSettings pass_settings(const EstimatorInput& input, const PhotonPlan& plan,
                                 std::uint64_t pass);
/// The kernels of photons on surfaces; `scale` as below.
RadiusSettings surface_radii(const EstimatorInput& input, float scale);
/// How wide the kernels of a pass are: `neighbours` photons in an adaptive kernel, radii times
/// `scale`.
RadiusSettings radius_settings(const EstimatorInput& input, double neighbours, float scale = 1);

} // namespace vdbeam
