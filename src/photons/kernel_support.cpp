#include "photons/kernel_support.h"

#include "math/sampling.h"
#include "photons/clear_kernel.h"
#include "tuning/constants.h"

namespace vdbeam {

namespace {

/// Two rings of six, at the quartiles of the biweight disc's weight: 1 - (1 - s)^3 = 1/4 and 3/4.
constexpr float ring_radii[2] = {0.302f, 0.608f};
constexpr float cos_sixth[6] = {1, 0.5f, -0.5f, -1, -0.5f, 0.5f};
constexpr float sin_sixth[6] = {0, 0.866025f, 0.866025f, 0, -0.866025f, -0.866025f};
/// A ring of twelve points about the kernel, which is looked at for leaks too [radii]: a straight
/// edge that cuts the kernel has one of them behind it.
constexpr float border = 1.0353f; // 1 / cos(15 degrees)
/// Discs before surfaces are tried at the least radius, at half of it and so on, down to this part
/// of the kernel's radius.
constexpr float least_cut = 1.0f / 16;

/// The plane of a photon's disc.
struct DiscPlane {
  DiscPlane(const Camera& camera, const Vec3f& photon) : center(photon) {
    orthonormal_frame(Vec3f(camera.direction_towards(Vec3d(photon))), u, v);
  }
  /// One of twelve points at a distance from the centre; those with odd numbers are between those
  /// with even ones.
  Vec3f point(int i, float distance) const {
    const bool turned = i % 2 != 0;
    const auto k = static_cast<std::size_t>(i / 2);
    const float c = turned ? sin_sixth[k] : cos_sixth[k], s = turned ? cos_sixth[k] : sin_sixth[k];
    return center + (u * c + v * s) * distance;
  }
  Vec3f center, u, v;
};

} // namespace

Kernel KernelSupport::fit(const Vec3f& photon, std::size_t part, float radius) const {
  Kernel kernel{radius};
  bool cut = false;
  if (const Surfaces* surfaces = world_->surfaces.get()) {
    const double far{far_from_surfaces * radius};
    const auto distance = static_cast<float>(surfaces->set->distance(Vec3d(photon), far));
    kernel = clear_kernel(radius, distance);
    if (domain_ == KernelDomain::disc)
      for (float wide = tuning::least_disc_before_surface * radius;
           !cut && wide > kernel.radius && wide >= least_cut * radius; wide /= 2)
        if ((cut = is_cut_without_leak(photon, wide)))
          kernel = {wide};
  }
  if (kernel.radius > 0 && (cut || by_medium_))
    kernel.share = domain_ == KernelDomain::disc ? disc_share(photon, part, kernel.radius, cut)
                                                 : ball_share(photon, part, kernel.radius);
  return kernel;
}

float KernelSupport::disc_share(const Vec3f& photon, std::size_t part, float radius,
                                bool cut) const {
  const DiscPlane plane(*camera_, photon);
  int hits = 0;
  // The outer ring is turned by a quarter of the plane's symmetry, so that twelve directions count.
  for (int i = 0; i < 12; ++i) {
    const Vec3f point = plane.point(i, radius * ring_radii[i % 2]);
    hits += (!by_medium_ || in_medium(point, part)) && (!cut || unobstructed(photon, point));
  }
  return std::max(least_share, static_cast<float>(hits) / 12);
}

float KernelSupport::ball_share(const Vec3f& photon, std::size_t part, float radius) const {
  // Faces and corners of a cube, at the root mean square distance of the biweight ball, r /
  // sqrt(3).
  const float face = 0.577f * radius, corner = 0.333f * radius;
  int hits = 0;
  for (int a = 0; a < 3; ++a)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f offset;
      offset[a] = sign * face;
      hits += in_medium(photon + offset, part);
    }
  for (int i = 0; i < 8; ++i)
    hits += in_medium(photon + Vec3f{i & 1 ? corner : -corner, i & 2 ? corner : -corner,
                                     i & 4 ? corner : -corner},
                      part);
  return std::max(least_share, static_cast<float>(hits) / 14);
}

/// Whether light leaks nowhere though the disc meets a surface.
bool KernelSupport::is_cut_without_leak(const Vec3f& photon, float radius) const {
  for (int i = 0; i < 12; ++i)
    if (leaks_to(photon, i, radius * border))
      return false;
  for (int i = 1; i < 12; i += 2)
    if (leaks_to(photon, i, radius * ring_radii[1]))
      return false;
  return true;
}

/// The i-th of twelve camera rays that pass the photon at a distance sees a point where it counts
/// the photon, but the photon does not. What is seen in mirrors is left out.
bool KernelSupport::leaks_to(const Vec3f& photon, int i, float distance) const {
  const std::optional<SeenPoint> seen = point_on_ray(photon, i, distance);
  if (!seen || unobstructed(photon, Vec3f(seen->point)))
    return false;
  const auto hit = world_->surfaces->set->intersect(seen->point, seen->view * -1.0, 0,
                                                    seen->distance, /*camera=*/true);
  if (!hit)
    return true;
  const Material& material = world_->surfaces->material(*hit);
  return material.is_specular() || material.refracts();
}

/// Where that ray comes nearest to the photon. The points of all such rays lie on a sphere through
/// the photon and the camera (Thales): near the camera they are far from the plane through the
/// photon.
std::optional<KernelSupport::SeenPoint> KernelSupport::point_on_ray(const Vec3f& photon, int i,
                                                                    float distance) const {
  constexpr double widest = 0.98; // sine of the angle at the camera
  // Rays of a lens or parallel ones do not all begin at the origin: theirs are taken in the plane.
  const bool own_origins = camera_->has_own_origins();
  const double away = length(Vec3d(photon) - camera_->origin());
  const double sine = std::min(double{distance} / away, widest);
  const float in_plane =
      own_origins ? distance : static_cast<float>(away * sine / std::sqrt(1 - sine * sine));
  const Vec3d target(DiscPlane(*camera_, photon).point(i, in_plane));
  const Vec3d view = camera_->direction_towards(target);
  const Vec3d from = own_origins ? target : camera_->origin();
  const double along = dot(Vec3d(photon) - from, view);
  const Vec3d point = from + view * along;
  const double from_camera = dot(point - camera_->origin(), view);
  if (!(from_camera > 0))
    return std::nullopt;
  return SeenPoint{point, view, from_camera};
}

bool KernelSupport::unobstructed(const Vec3f& photon, const Vec3f& point) const {
  const Vec3f to_point = point - photon;
  const float distance = length(to_point);
  return !(distance > 0) || unoccluded(*world_, Vec3d(photon), to_point / distance, distance);
}

void fit_kernels(const EstimatorInput& input, KernelDomain domain, bool by_medium, PhotonMap& map) {
  if (!input.world.surfaces && !by_medium)
    return;
  const KernelSupport support(input, domain, by_medium);
  map.fit([&](const Vec3f& photon, std::size_t part,
              float radius) { return support.fit(photon, part, radius); },
          input.stop);
}

} // namespace vdbeam
