#pragma once

#include "math/grouped_light.h"
#include "medium/emission.h"
#include "transport/scene_flight.h"

namespace vdbeam {

/// A random walk from the camera on, for the light that comes the other way.
struct CameraWalk : SceneFlight {
  using SceneFlight::SceneFlight;

  float gathered = 0; ///< distance along the flight up to which the light that it meets was added

  void set_out(const World& world, const Vec3d& origin, const Vec3f& direction) {
    gathered = 0;
    SceneFlight::set_out(world, origin, direction);
  }
};

/// The lights, but for surfaces, that a segment meets; weight(i): factor of light i.
template <class Weight>
GroupedLight lights_met(const World& world, const Segment& segment, const Weight& weight) {
  GroupedLight sum;
  for (const std::size_t i : world.lights.met_by_rays())
    if (const float factor = weight(i); factor > 0)
      sum.add(world.lights[i].emitted_radiance(segment).radiance * factor, world.lights.group(i));
  return sum;
}

/// Light that the walk's flight meets, from where it was gathered last: the medium's own up to
/// medium_end, and that of the lights up to t_end.
template <class Weight>
GroupedLight meet_light(const World& world, CameraWalk& walk, float medium_end, float t_end,
                        const Weight& weight) {
  const Ray& ray = walk.segment.ray;
  GroupedLight light;
  if (!world.medium.emitters.empty() && walk.gathered < medium_end)
    light.add(sample_emission(world.medium, {ray, walk.gathered, medium_end}, walk.rng),
              world.lights.group_of_emission());
  if (world.lights.any_extent() || t_end == infinity)
    light += lights_met(world, {ray, walk.gathered, t_end}, weight);
  walk.gathered = t_end;
  return light *= walk.throughput;
}

} // namespace vdbeam
