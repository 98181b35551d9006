#include "photons/hidden_lights.h"

#include "medium/distance_sampling.h"
#include "medium/equi_angular.h"
#include "photons/photon_plan.h"
#include "transport/camera_ray.h"
#include "transport/next_event.h"

#include <tbb/parallel_for.h>

#include <atomic>

namespace vdbeam {

namespace {

/// Camera rays along each axis of the picture, and points on each of them. A light that one ray in
/// two thousand sees is missed with a chance of a tenth; photons bring its light then.
constexpr int rays_across = 64;
constexpr int points_per_ray = 2;

/// Looks for lights from points on camera rays.
class Search {
public:
  Search(const EstimatorInput& input, const std::vector<bool>& sampled)
      : input_(input), world_(input.world), found_(sampled.size()) {
    for (std::size_t l = 0; l < sampled.size(); ++l)
      found_[l] = !sampled[l]; // none is looked for
  }

  bool found(std::size_t light) const { return found_[light]; }

  void look_from_row(int row) {
    for (int column = 0; column < rays_across && !all_found(); ++column)
      look_along(row, column);
  }

private:
  bool all_found() const {
    return std::all_of(found_.begin(), found_.end(),
                       [](const auto& found) { return found.load(); });
  }

  /// Each light has random numbers of its own on each ray: whether it is found must not depend on
  /// which others another thread has found.
  Rng stream(int row, int column, std::size_t of) const {
    const auto ray = static_cast<std::uint64_t>(row * rays_across + column);
    return {{input_.settings.seed, input_.frame, sight_pass},
            RngStage::direct,
            of * rays_across * rays_across + ray};
  }

  void look_along(int row, int column) {
    Rng rng = stream(row, column, 0);
    const auto along = [&](int step, int pixels) {
      return (step + static_cast<double>(rng.uniform())) * pixels / rays_across;
    };
    const double x = along(column, input_.camera.width()), y = along(row, input_.camera.height());
    const CameraRay camera = camera_ray(world_, input_.camera, input_.camera.ray(x, y));
    DepthProfile profile;
    profile.build(world_.medium, camera.segment, static_cast<float>(input_.settings.cutoff));
    if (profile.empty())
      return;
    DistanceSampler distances(world_.medium, camera.ray(), profile);
    if (!(distances.opacity(0) > 0))
      return;
    Vec3f points[points_per_ray];
    for (Vec3f& point : points)
      point = distances.sample(rng.uniform(), 0).position;
    for (std::size_t l = 0; l < found_.size(); ++l) {
      Rng own = stream(row, column, 1 + l);
      for (int i = 0; i < points_per_ray && !found_[l]; ++i)
        if (sees(l, points[i], own) || sees(l, near(l, camera.ray(), profile, own), own))
          found_[l] = true;
    }
  }

  /// A point on the ray that is likely to be near the light, for those that stand somewhere.
  Vec3f near(std::size_t light, const Ray& ray, const DepthProfile& profile, Rng& rng) const {
    const Vec3d* position = world_.lights[light].position();
    const float u = rng.uniform(), begin = profile.front(), end = profile.back();
    return ray.at(position && begin < end ? EquiAngular(ray, *position, begin, end).sample(u)
                                          : begin + u * (end - begin));
  }

  bool sees(std::size_t light, const Vec3f& point, Rng& rng) const {
    return sample_direct_light(world_, world_.lights[light], AnyVertex{point}, rng).has_value();
  }

  const EstimatorInput& input_;
  const World& world_;
  std::vector<std::atomic<bool>> found_;
};

} // namespace

std::vector<bool> lights_in_sight(const EstimatorInput& input, std::vector<bool> sampled) {
  if (!input.world.surfaces)
    return sampled;
  Search search(input, sampled);
  tbb::parallel_for(0, rays_across, [&](int row) { search.look_from_row(row); });
  for (std::size_t l = 0; l < sampled.size(); ++l)
    sampled[l] = sampled[l] && search.found(l);
  return sampled;
}

} // namespace vdbeam
