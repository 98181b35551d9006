#pragma once

#include "photonmap/photon_map.h"
#include "rays/estimator_input.h"

namespace vdbeam {

/// The fraction of a photon's kernel that lies where photons can be stored: in cells whose majorant
/// is not 0. A kernel at the edge of the medium extends into space that never holds a photon, and
/// the estimate is too dark by that fraction. Dividing a photon's power by the fraction inside
/// removes this boundary bias to first order; the factor tends to 1 as radii shrink, so the
/// estimate stays consistent.
class KernelSupport {
public:
  /// The medium, in render space, and the camera, which may move in between, must outlive this.
  KernelSupport(const Medium& medium, const Camera& camera) : medium_(&medium), camera_(&camera) {}

  /// Fraction of the disc of radius r around a photon, perpendicular to the ray of the picture that
  /// comes nearest. (Beside the camera a photon is seen by rays that do not lead to it at all.)
  float disc_share(const Vec3f& photon, float radius) const;
  /// Fraction of the ball of radius r.
  float ball_share(const Vec3f& photon, float radius) const;

  /// No photon is raised by more than 1 / least_share.
  static constexpr float least_share = 0.25f;

private:
  bool inside(const Vec3f& point) const;

  const Medium* medium_;
  const Camera* camera_;
};

/// Domain over which a kernel is normalised: the disc across the camera ray, or the ball.
enum class KernelDomain { disc, ball };

/// Makes kernels end before the world's surfaces, if there are any (PhotonMap::keep_clear).
void clear_of_surfaces(const World& world, PhotonMap& map);

/// Makes the kernels of a map what they are to be in the world: none reaches through a surface,
/// and each is divided by its share, if there is one.
void fit_kernels(const World& world, const KernelShare& share, PhotonMap& map);

/// The share that photons' powers of a map are to be divided by for this camera; none where the
/// estimate gains nothing by it. The input's world and camera must outlive it.
KernelShare boundary_share(const EstimatorInput& input, KernelDomain domain);

} // namespace vdbeam
