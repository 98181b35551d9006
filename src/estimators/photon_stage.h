#pragma once

#include "estimators/camera_ray.h"
#include "estimators/estimator.h"
#include "estimators/kernel_support.h"
#include "photonmap/photon_map.h"
#include "transport/depth_profile.h"
#include "transport/photon_tracing.h"

namespace vdbeam {

/// The photon pass that `beam` and `march` share: how many paths, which lights' first flight is
/// left to shadow rays, how wide the kernels are, and the map itself.
class PhotonStage {
public:
  explicit PhotonStage(const EstimatorInput& input);

  /// Traces and builds the map of a pass. Radii shrink from pass to pass.
  void shoot(int pass, RenderStatistics& statistics);

  const PhotonMap& map() const { return map_; }
  /// Per light: single scattering by shadow rays instead of photons.
  const std::vector<bool>& sampled_lights() const { return sampled_; }
  /// Shadow-ray samples per camera ray.
  int direct_samples() const { return direct_samples_; }
  /// Colour that is already in the photons' power (the albedo that all volumes share).
  bool albedo_in_power() const { return common_albedo_; }
  bool needs_map() const { return needs_map_; }

  /// Radius factor of a pass: r_p^2 = r_0^2 prod (i + alpha) / (i + 1) (Knaus and Zwicker 2011).
  static float radius_scale(int pass, double alpha);

private:
  void choose_lights();
  void choose_counts();
  void choose_thinning(const PhotonPass& pilot);
  std::uint64_t choose_paths() const;
  bool may_try_kernels() const;
  void choose_neighbours();
  float kernel_reach(const PhotonList& pilot) const;
  PhotonPassSettings pass_settings(std::uint64_t pass) const;
  RadiusSettings radii(int pass) const;
  void make_map(const PhotonPassSettings& settings, const RadiusSettings& radii,
                RenderStatistics& statistics);

  EstimatorInput input_;
  std::vector<bool> sampled_;
  bool common_albedo_ = false;
  bool needs_map_ = true;
  int direct_samples_ = 1;
  double keep_ = 1; ///< share of the collisions that are stored, where it is the same everywhere
  std::shared_ptr<const CellTables> keep_by_cell_; ///< else
  double stored_per_path_ = 0;
  std::uint64_t importance_rays_ = 0;
  double neighbours_ = 0;
  std::uint64_t paths_ = 0; ///< light paths per pass
  KernelSupport support_;
  PhotonMap map_;
};

} // namespace vdbeam
