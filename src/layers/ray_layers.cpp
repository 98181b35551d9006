#include "layers/ray_layers.h"

#include "layers/opacity_pieces.h"
#include "layers/plane_layers.h"
#include "layers/scene_objects.h"

#include <algorithm>

namespace vdbeam {
namespace {

/// Parts of a ray's opacity before the nearest and the farthest depth: the first and the last
/// hundredth do not count.
constexpr float near_share = 0.01f, far_share = 0.99f;

/// Opacity that a piece of the ray between two knots adds.
struct Piece {
  float t = 0;              ///< where it does so, on average
  float total = 0;          ///< of all volumes
  std::vector<float> added; ///< by each volume of the medium
};

/// Calls visit(piece) for each piece of the ray that adds anything: the integral of Tr sigma_t dt,
/// mean over channels.
template <class Visit>
void for_each_piece(const Medium& medium, const DepthProfile& profile, const Visit& visit) {
  Piece piece;
  const std::size_t volumes = medium.volumes.size();
  for (std::size_t knot = 1; !profile.empty() && knot < profile.knots(); ++knot) {
    piece.added.assign(volumes, 0);
    add_opacity(medium, profile, knot,
                [&](std::size_t v, float share) { piece.added[v] += share; });
    piece.total = 0;
    for (const float added : piece.added)
      piece.total += added;
    if (!(piece.total > 0))
      continue;
    const float depth = mean_component(profile.channels(medium, knot)) -
                        mean_component(profile.channels(medium, knot - 1));
    piece.t = profile.t(knot - 1) + mean_collision(depth) * (profile.t(knot) - profile.t(knot - 1));
    visit(piece);
  }
}

float opacity_at(const Medium& medium, const DepthProfile& profile, std::size_t knot) {
  const Rgb tau = profile.channels(medium, knot);
  return mean_component(Rgb(opacity_of(tau.x), opacity_of(tau.y), opacity_of(tau.z)));
}

/// Where on the ray so much of its opacity is reached; `end` where the medium has less.
float distance_of(const Medium& medium, const DepthProfile& profile, float opacity, float end) {
  float before = 0;
  for (std::size_t knot = 1; !profile.empty() && knot < profile.knots(); ++knot) {
    const float after = opacity_at(medium, profile, knot);
    if (after >= opacity && after > before) {
      const float whole = std::log1p((before - after) / (1 - before)),
                  part = std::log1p((before - opacity) / (1 - before));
      const float share = after < 1 && whole < 0 ? std::clamp(part / whole, 0.0f, 1.0f) : 0.0f;
      return profile.t(knot - 1) + share * (profile.t(knot) - profile.t(knot - 1));
    }
    before = after;
  }
  return end;
}

/// Gradient of a volume's extinction at a point, per render unit squared: by differences over a
/// voxel, which are exact where it is linear.
Vec3f extinction_gradient(const Volume& volume, const Vec3f& point) {
  const Vec3f local = volume.local_point(point);
  Vec3f gradient;
  for (int a = 0; a < 3; ++a) {
    Vec3f step;
    step[a] = 0.5f;
    const float slope = volume.field.sample(local + step) - volume.field.sample(local - step);
    gradient += volume.to_local.rows[static_cast<std::size_t>(a)] * slope;
  }
  return gradient * (volume.extinction * mean_component(volume.channel_scale));
}

} // namespace

RayLayers::RayLayers(const Scene& scene, const Velocities& velocities)
    : names_(plane_names(scene)), near_(find("depth_near.Z")), far_(find("depth_far.Z")),
      position_(find("position.X")), motion_(find("motion.X")),
      gradient_(find("density_gradient.X")), albedo_(find("denoising_albedo.B")),
      normal_(find("denoising_normal.X")), holdout_(find("holdout.Y")), shadow_(find("shadow.B")),
      added_(find("catcher_light.B")) {
  const SceneObjects objects = scene_objects(scene);
  for (const std::size_t object : objects.of_volume) {
    volume_planes_.push_back(find("volume_" + objects.names[object] + ".A"));
    if (volume_planes_.back() >= 0) {
      ++volume_planes_.back(); // that of B
      tells_volumes_ = true;
    }
  }
  if (motion_ >= 0)
    scene_motion_.emplace(scene, velocities);
}

RayLayers RayLayers::at(const Scene& moment) const {
  RayLayers result = *this;
  if (result.scene_motion_)
    result.scene_motion_->set_moment(moment);
  return result;
}

int RayLayers::find(const std::string& name) const {
  const auto found = std::lower_bound(names_.begin(), names_.end(), name);
  return found != names_.end() && *found == name ? static_cast<int>(found - names_.begin()) : -1;
}

bool RayLayers::is_light(std::size_t plane) const {
  return plane_layer_of(names_[plane]).name == "volume_" && !names_[plane].ends_with(".A");
}

namespace {

/// A point of render space in the world.
Vec3d in_world(const RenderSpace& space, const Vec3d& point) {
  return point / space.scale + space.origin;
}

} // namespace

/// The planes' values at a pixel.
class RayLayers::Planes {
public:
  Planes(std::size_t pixel, PassImage& image) : pixel_(pixel), image_(image) {}

  /// `plane`: -1 for one that nobody asks for.
  void add(int plane, double value) const {
    if (plane >= 0)
      image_.planes[static_cast<std::size_t>(plane)][pixel_] += static_cast<float>(value);
  }
  /// Planes of colours are in the order B, G, R.
  void add_color(int blue, const Vec3d& color) const {
    add(blue, Vec3d{color.z, color.y, color.x});
  }
  void add(int first, const Vec3d& value) const {
    for (int a = 0; a < 3 && first >= 0; ++a)
      add(first + a, value[a]);
  }

private:
  std::size_t pixel_;
  PassImage& image_;
};

void RayLayers::record(const World& world, const CameraRay& camera, const DepthProfile& profile,
                       const Seen& seen, std::size_t pixel, PassImage& image) const {
  const Planes planes(pixel, image);
  const Medium& medium = world.medium;
  const float behind = record_surface(world, camera, seen, planes);
  const float through = profile.empty() ? 0 : opacity_at(medium, profile, profile.knots() - 1);
  const float opacity = through + behind;
  if (!(opacity > 0))
    return;
  const auto distance = [&](float share) {
    const float end = behind > 0 ? camera.whole().t_end : profile.empty() ? 0 : profile.back();
    return (static_cast<double>(distance_of(medium, profile, share * opacity, end)) +
            camera.shift) /
           world.space.scale;
  };
  if (near_ >= 0)
    planes.add(near_, opacity * distance(near_share));
  if (far_ >= 0)
    planes.add(far_, opacity * distance(far_share));
  if (position_ >= 0) {
    const Ray& ray = camera.ray();
    const Vec3d eye =
        in_world(world.space, Vec3d(ray.origin) - Vec3d(ray.direction) * camera.shift);
    planes.add(position_, eye * static_cast<double>(opacity) +
                              Vec3d(ray.direction) * static_cast<double>(seen.depth));
  }
  if (camera.hit && motion_ >= 0 && behind > 0) {
    const SceneMotion::Pixels moved = scene_motion_->of_mesh(
        static_cast<std::size_t>(camera.hit->surface), in_world(world.space, camera.hit->position));
    for (int a = 0; a < 2; ++a)
      planes.add(motion_ + a, behind * moved[static_cast<std::size_t>(a)]);
  }
  if (camera.hit && behind > 0)
    record_features_of_surface(world, camera, behind, planes);
  record_pieces(world, camera, profile, planes);
}

/// What guides a denoiser at the surface at the ray's end. Metal and glass, whose colour does not
/// vary over them, count as white, as Open Image Denoise proposes.
void RayLayers::record_features_of_surface(const World& world, const CameraRay& camera,
                                           float behind, const Planes& planes) const {
  if (albedo_ < 0 && normal_ < 0)
    return;
  const Vec3f& direction = camera.ray().direction;
  const SurfaceVertex vertex(*world.surfaces, *camera.hit, direction);
  Rgb albedo;
  if (vertex.light() >= 0)
    albedo = min(vertex.emitted(), Rgb(1));
  else if (!vertex.material().is_shadow_catcher())
    albedo = vertex.material().shows_surroundings() ? Rgb(1) : vertex.guide_albedo();
  planes.add_color(albedo_, Vec3d(albedo) * static_cast<double>(behind));
  const Vec3f normal = vertex.hit().shading_normal * (vertex.front() ? behind : -behind);
  planes.add(normal_, Vec3d(normal));
}

/// The planes of the surface at the ray's end; returns what the ray shows of it.
float RayLayers::record_surface(const World& world, const CameraRay& camera, const Seen& seen,
                                const Planes& planes) const {
  if (!camera.hit) {
    planes.add_color(shadow_, Vec3d(seen.left));
    return 0;
  }
  const float left = mean_component(seen.left);
  const Material& material = world.surfaces->material(*camera.hit);
  if (material.is_holdout()) {
    planes.add(holdout_, static_cast<double>(left));
    planes.add_color(shadow_, Vec3d(seen.left));
    return 0;
  }
  if (!material.is_shadow_catcher())
    return left;
  planes.add_color(shadow_, Vec3d(seen.left * seen.plate_left));
  planes.add_color(added_, Vec3d(seen.left * seen.added));
  return left * seen.shadow;
}

/// The planes of the medium that the ray meets, piece by piece of its profile.
void RayLayers::record_pieces(const World& world, const CameraRay& camera,
                              const DepthProfile& profile, const Planes& planes) const {
  const bool turned = gradient_ >= 0 || normal_ >= 0;
  if (motion_ < 0 && albedo_ < 0 && !turned && !tells_volumes_)
    return;
  const Medium& medium = world.medium;
  const double scale = world.space.scale;
  Vec3d inwards;
  double whole = 0;
  for_each_piece(medium, profile, [&](const Piece& piece) {
    const Vec3f point = camera.ray().at(piece.t);
    Vec3f gradient;
    for (std::size_t i = 0; i < profile.volume_count(); ++i) {
      const std::size_t v = profile.volume(i);
      const Volume& volume = medium.volumes[v];
      const auto share = static_cast<double>(piece.added[v]);
      if (volume_planes_[volume.setting] >= 0)
        planes.add(volume_planes_[volume.setting] - 1, share);
      if (turned)
        gradient += extinction_gradient(volume, point);
      if (albedo_ >= 0 && share > 0)
        planes.add_color(albedo_, Vec3d(volume.albedo_at(point)) * share);
      if (motion_ < 0 || !(share > 0))
        continue;
      const SceneMotion::Pixels moved =
          scene_motion_->of_volume(volume.setting, in_world(world.space, Vec3d(point)));
      planes.add(motion_, share * moved[0]);
      planes.add(motion_ + 1, share * moved[1]);
    }
    const auto total = static_cast<double>(piece.total);
    planes.add(gradient_, Vec3d(gradient) * (scale * scale * total));
    inwards += Vec3d(gradient) * total;
    whole += total;
  });
  // The mean over the ray before it is made a normal: of single voxels it would be noise.
  if (const double size = length(inwards); size > 0)
    planes.add(normal_, inwards * (-whole / size));
}

} // namespace vdbeam
