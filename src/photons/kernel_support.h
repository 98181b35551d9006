#pragma once

#include "photonmap/photon_map.h"
#include "rays/estimator_input.h"

#include <optional>

namespace vdbeam {

/// Domain over which a kernel is normalised: the disc across the camera ray, or the ball.
enum class KernelDomain { disc, ball };

/// Fits the kernels of photons to the space that photons can be in: before surfaces, and in cells
/// of the medium whose majorant is not 0.
///
/// A kernel that reaches beyond takes light where none was, and is too dark where it ends. Dividing
/// the photon's power by the share of the kernel inside removes this boundary bias to first order;
/// the factor tends to 1 as radii shrink, so the estimate stays consistent. Surfaces may also let
/// light leak, to what the photon cannot see. There kernels shrink and end before the surface
/// (clear_kernel), for noise: small kernels are bright. A disc that a surface cuts leaks nothing if
/// the camera sees no more of it than the photon does, as before a ground or a wall. It keeps its
/// radius.
class KernelSupport {
public:
  /// `by_medium`: kernels are divided by the share that lies in the medium. The input's world and
  /// camera, which may move in between, must outlive this.
  KernelSupport(const EstimatorInput& input, KernelDomain domain, bool by_medium)
      : world_(&input.world), camera_(&input.camera), domain_(domain), by_medium_(by_medium) {}

  /// `part`: of the medium, that of the photon (Medium::parts).
  Kernel fit(const Vec3f& photon, std::size_t part, float radius) const;

  /// No photon is raised by more than 1 / least_share.
  static constexpr float least_share = 0.25f;

private:
  /// The disc is perpendicular to the ray of the image that comes nearest. (Beside the camera a
  /// photon is seen by rays that do not lead to it at all.)
  float disc_share(const Vec3f& photon, std::size_t part, float radius, bool cut) const;
  float ball_share(const Vec3f& photon, std::size_t part, float radius) const;
  bool is_cut_without_leak(const Vec3f& photon, float radius) const;
  bool leaks_to(const Vec3f& photon, int i, float distance) const;
  /// A point at a distance from the camera, along a unit direction.
  struct SeenPoint {
    Vec3d point, view;
    double distance;
  };
  std::optional<SeenPoint> point_on_ray(const Vec3f& photon, int i, float distance) const;
  bool in_medium(const Vec3f& point, std::size_t part) const {
    return world_->medium.majorant(point, part) > 0;
  }
  bool unobstructed(const Vec3f& photon, const Vec3f& point) const;

  const World* world_;
  const Camera* camera_;
  KernelDomain domain_;
  bool by_medium_;
};

/// Makes the kernels of a map what they are to be in the input's world (KernelSupport). Where the
/// input's `stop` says so it ends early, and some stay as they were.
void fit_kernels(const EstimatorInput& input, KernelDomain domain, bool by_medium, PhotonMap& map);

} // namespace vdbeam
