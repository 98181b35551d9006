#include "walks/lamp_shells.h"

#include "medium/equi_angular.h"
#include "medium/optical_depth.h"
#include "transport/light_draw.h"
#include "transport/next_event.h"
#include "tuning/constants.h"

#include <cmath>

namespace vdbeam {

namespace {

/// Extinction of all volumes at a point, of the strongest channel [per render unit].
float extinction_at(const Medium& medium, const Vec3f& point) {
  float sum = 0;
  medium.for_each_at(point, [&](std::size_t v) {
    sum += medium.volumes[v].density(point) * medium.volumes[v].extinction;
  });
  return sum;
}

/// A vertex (MediumVertex) that all volumes at a point scatter from: by their scattering
/// coefficients times their phase functions.
struct MixedVertex {
  const Medium& medium;
  const Vec3f& point;
  const Vec3f& arriving;

  const Vec3f& position() const { return point; }
  Vec3d leave(const Vec3f&) const { return Vec3d(point); }
  Rgb evaluate(const Vec3f& wi) const {
    const float cosine = dot(arriving, wi);
    const std::vector<PhaseFunction>& phases = medium.gathered_phases();
    Rgb sum;
    medium.for_each_at(point, [&](std::size_t v) {
      const Volume& volume = medium.volumes[v];
      if (const float density = volume.density(point); density > 0)
        sum += volume.albedo_at(point) * volume.channel_scale *
               (density * volume.extinction *
                phases[static_cast<std::size_t>(volume.phase_index)].evaluate(cosine));
    });
    return sum;
  }
};

/// The part of the segment inside of a ball; empty where it misses.
Segment part_in_ball(const Segment& segment, const Vec3d& center, double radius) {
  const Vec3d to_center = center - Vec3d(segment.ray.origin), direction(segment.ray.direction);
  const double nearest = dot(to_center, direction);
  const Vec3d across = to_center - direction * nearest;
  const double half_squared = radius * radius - dot(across, across);
  if (!(half_squared > 0))
    return {segment.ray, 0, 0};
  const double half = std::sqrt(half_squared);
  return {segment.ray, std::max(segment.t_begin, static_cast<float>(nearest - half)),
          std::min(segment.t_end, static_cast<float>(nearest + half))};
}

} // namespace

LampShells::LampShells(const World& world, const std::vector<bool>& sampled) : world_(world) {
  if (world.medium.empty())
    return;
  const Boxf& box = world.medium.bounds;
  const double size{0.5f * length(box.upper - box.lower)};
  for (std::size_t l = 0; l < world.lights.size(); ++l) {
    const Vec3d* const lamp = world.lights[l].position();
    if (!lamp || !sampled[l] || !world.lights[l].is_delta())
      continue;
    const double extinction{extinction_at(world.medium, Vec3f(*lamp))};
    double radius = tuning::widest_lamp_shell * size;
    if (extinction * radius > tuning::depth_of_lamp_shell)
      radius = tuning::depth_of_lamp_shell / extinction;
    const Vec3d nearest = min(max(*lamp, Vec3d(box.lower)), Vec3d(box.upper));
    if (!(length(nearest - *lamp) < radius))
      continue;
    shell_of_light_.resize(world.lights.size(), -1);
    shell_of_light_[l] = static_cast<int>(shells_.size());
    shells_.push_back({l, *lamp, radius});
  }
}

/// Null where it has none.
const LampShells::Shell* LampShells::shell_of(std::size_t light) const {
  const int shell = shell_of_light_.empty() ? -1 : shell_of_light_[light];
  return shell < 0 ? nullptr : &shells_[static_cast<std::size_t>(shell)];
}

double LampShells::radius_of(std::size_t light) const {
  const Shell* const shell = shell_of(light);
  return shell ? shell->radius : 0;
}

bool LampShells::holds(std::size_t light, const Vec3f& point) const {
  const Shell* const shell = shell_of(light);
  return shell && length(Vec3d(point) - shell->center) < shell->radius;
}

GroupedLight LampShells::along(const Segment& flight, Rng& rng, std::uint64_t& shadow_rays) const {
  std::vector<Crossing> crossings;
  std::vector<DrawnLight> drawn; // of the crossings
  for (const Shell& shell : shells_) {
    const Light& lamp = world_.lights[shell.light];
    const Segment lit = lamp.lit_part(part_in_ball(flight, shell.center, shell.radius));
    if (lit.empty())
      continue;
    drawn.push_back({crossings.size(), lamp_importance(lamp, lit)});
    crossings.push_back({&shell, lit});
  }
  draw_systematically(drawn, 0, LightDraw::most(), rng);
  shadow_rays += drawn.size();
  GroupedLight sum;
  for (const auto& [i, weight] : drawn)
    sum.add(sample(crossings[i], rng) * weight, world_.lights.group(crossings[i].shell->light));
  return sum;
}

Rgb LampShells::sample(const Crossing& crossing, Rng& rng) const {
  const Medium& medium = world_.medium;
  const auto& [shell, segment] = crossing;
  const Ray& ray = segment.ray;
  const EquiAngular distances(ray, shell->center, segment.t_begin, segment.t_end,
                              medium.angles.get());
  const float t = distances.sample(rng.uniform()), density = distances.pdf(t);
  const Vec3f point = ray.at(t);
  const auto direct = sample_direct_light(world_, world_.lights[shell->light],
                                          MixedVertex{medium, point, ray.direction}, rng);
  if (!direct || !(density > 0))
    return {};
  Rgb through = estimate_transmittance(medium, {ray, 0, t}, rng.uniform());
  if (max_component(through) > 0)
    through *= estimate_transmittance(medium, direct->segment, rng.uniform());
  return direct->radiance() * through / density;
}

} // namespace vdbeam
