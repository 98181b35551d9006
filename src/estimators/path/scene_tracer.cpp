#include "estimators/path/scene_tracer.h"

#include "medium/bounded_tracking.h"
#include "medium/emission.h"
#include "medium/optical_depth.h"

#include <utility>

namespace vdbeam {

/// A path on its way; its ray begins at its last vertex.
struct SceneTracer::Path {
  Rng& rng;
  Rgb throughput;
  Vec3d origin;
  Vec3f direction;
  float pdf = 0;              ///< with which the direction was drawn; 0: nothing else draws it
  bool skips_sampled = false; ///< light straight from lights with shadow rays counts elsewhere
  bool all_light = true;      ///< else such light counts on surfaces that it reaches straight only
  bool from_surface = false;  ///< the present flight begins at one whose straight light counts
  int scatterings = 0;        ///< in the medium
  ScatteredLight light;       ///< so far; from a surface all is in `direct`
  LengthRoulette length;
  SurfaceRoulette surfaces;
  bool begins = false;  ///< it is at its first vertex, a surface
  float refraction = 1; ///< factor of the throughput that is no loss: roulette looks beyond it

  Ray ray() const { return {Vec3f(origin), direction}; }
  /// Light straight from lights with shadow rays counts elsewhere on the present flight.
  bool leaves_out_sampled() const { return skips_sampled || (!all_light && !from_surface); }
  void add(const Rgb& value) { (scatterings > 1 ? light.indirect : light.direct) += value; }
};

Rgb SceneTracer::from_surface(const SurfaceHit& hit, const Vec3f& direction, Rng& rng,
                              bool all_light, float emitted) const {
  const SurfaceVertex vertex(*world_.surfaces, hit, direction);
  Path path{rng, Rgb(1), {}, direction, 0, false, all_light, false, 0, {}, {}, {}, true, 1};
  path.add(vertex.emitted() * emitted);
  path.throughput *= vertex.absorbed();
  if (bounce(path, vertex))
    follow(path);
  return path.light.direct + path.light.indirect;
}

ScatteredLight SceneTracer::from_medium(const Ray& ray, const Rgb& throughput,
                                        const PhaseFunction& phase, Rng& rng) const {
  const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
  const Vec3f direction = phase.sample(ray.direction, u_lobe, u, v);
  const float pdf = phase.evaluate(dot(ray.direction, direction));
  Path path{rng,   throughput, Vec3d(ray.origin), direction, pdf, true, true, false, 1, {}, {}, {},
            false, 1};
  follow(path);
  return path.light;
}

void SceneTracer::follow(Path& path) const {
  const SurfaceSet& set = *world_.surfaces->set;
  for (;;) {
    const auto met =
        set.intersect(path.origin, Vec3d(path.direction), 0, static_cast<double>(infinity));
    const float t_end = met ? static_cast<float>(met->t) : infinity;
    Collision hit;
    if (fly(path, t_end, world_.surfaces->medium_end(met, path.direction), hit)) {
      if (!collide(path, hit))
        return;
      continue;
    }
    if (!met)
      return;
    const SurfaceVertex vertex(*world_.surfaces, *met, path.direction);
    path.throughput *= vertex.absorbed();
    const int light = vertex.light();
    if (light >= 0 && max_component(vertex.emitted()) > 0) {
      const bool sampled = shadow_rays_[static_cast<std::size_t>(light)];
      float weight = sampled && path.leaves_out_sampled() ? 0 : 1;
      if (sampled && path.pdf > 0)
        weight *= path.pdf / (path.pdf + world_.lights[static_cast<std::size_t>(light)].surface_pdf(
                                             *met, path.direction));
      path.add(vertex.emitted() * path.throughput * weight);
    }
    if (!bounce(path, vertex))
      return;
  }
}

/// Flies on up to t_end and gathers what shines on the way. True where the medium, which ends at
/// medium_end, scatters or absorbs before.
bool SceneTracer::fly(Path& path, float t_end, float medium_end, Collision& hit) const {
  const Medium& medium = world_.medium;
  const Ray ray = path.ray();
  const bool emits = !medium.emitters.empty();
  float gathered = 0;
  const auto gather = [&](float t) {
    if (emits && gathered < t)
      path.add(sample_emission(medium, {ray, gathered, t}, path.rng) * path.throughput);
    gathered = t;
  };
  bool collided = false;
  if (!medium.empty()) {
    BoundedTracker tracker(medium, {ray, 0, medium_end});
    for (hit = tracker.next(path.rng); hit.volume; hit = tracker.next(path.rng)) {
      // A coloured throughput changes at null collisions too.
      if (medium.chromatic)
        gather(hit.t);
      collided = sample_real_collision(hit, medium.chromatic, path.throughput, path.rng);
      if (collided)
        break;
      // Without colours those have a bound of their own.
      if (medium.chromatic && !path.length.survive(path.throughput, path.rng)) {
        path.throughput = Rgb(0);
        break;
      }
    }
  }
  gather(collided ? hit.t : medium_end);
  path.add(lights_met(path, collided ? hit.t : t_end) * path.throughput);
  return collided;
}

bool SceneTracer::collide(Path& path, const Collision& hit) const {
  if (max_bounces_ && path.scatterings >= *max_bounces_)
    return false;
  const Vec3f point = path.ray().at(hit.t);
  path.throughput *= hit.volume->albedo_at(point);
  if (!survive_roulette(roulette_below * path.refraction, path.throughput, path.rng) ||
      !path.length.survive(path.throughput, path.rng))
    return false;
  const PhaseFunction& phase =
      world_.medium.phases[static_cast<std::size_t>(hit.volume->phase_index)];
  ++path.scatterings;
  if (path.all_light)
    path.add(lights_at_collision(path, point, phase, path.rng) * path.throughput);
  const float u_lobe = path.rng.uniform(), u = path.rng.uniform(), v = path.rng.uniform();
  const Vec3f direction = phase.sample(path.direction, u_lobe, u, v);
  path.pdf = phase.evaluate(dot(path.direction, direction));
  path.origin = Vec3d(point);
  path.direction = direction;
  path.skips_sampled = false;
  path.from_surface = false;
  return true;
}

/// Scatters the path at a surface. False where it ends.
bool SceneTracer::bounce(Path& path, const SurfaceVertex& vertex) const {
  const Material& material = vertex.material();
  if (material.is_black())
    return false;
  const bool counts_straight =
      !material.is_specular() && (path.all_light || path.begins || !material.throws_light());
  path.begins = false;
  if (counts_straight)
    path.add(lights_at_surface(vertex, path.rng) * path.throughput);
  const MaterialSample next = vertex.sample(Carried::radiance, path.rng);
  path.throughput *= next.weight;
  path.refraction *= next.refraction;
  if (!survive_roulette(roulette_below * path.refraction, path.throughput, path.rng) ||
      !path.surfaces.survive(path.throughput, path.rng))
    return false;
  path.pdf = next.pdf;
  path.origin = vertex.hit().leave(next.wi);
  path.direction = next.wi;
  path.skips_sampled = false;
  path.from_surface = counts_straight;
  return true;
}

/// Next-event estimation: the lights with shadow rays, each by a sample that is weighted against
/// the direction that the path will draw. scatter(wi): what is scattered to the path from there,
/// and the density of drawing wi; transmittance(sample): between the point and the sample.
template <class Scatter, class Transmittance>
Rgb SceneTracer::sample_lights(const Vec3f& point, Rng& rng, const Scatter& scatter,
                               const Transmittance& transmittance) const {
  Rgb sum;
  for (std::size_t i = 0; i < world_.lights.size(); ++i) {
    if (!shadow_rays_[i])
      continue;
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample sample = world_.lights[i].sample_incident(point, u, v);
    if (max_component(sample.value) <= 0)
      continue;
    const auto [value, pdf] = scatter(sample.wi);
    if (max_component(value) <= 0)
      continue;
    const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + pdf) : 1;
    sum += sample.value * value * weight * transmittance(sample);
  }
  return sum;
}

Rgb SceneTracer::lights_at_collision(const Path& path, const Vec3f& point,
                                     const PhaseFunction& phase, Rng& rng) const {
  const auto scatter = [&](const Vec3f& wi) {
    const float p = phase.evaluate(dot(path.direction, wi));
    return std::pair(Rgb(p), p);
  };
  return sample_lights(point, rng, scatter, [&](const IncidentSample& sample) {
    if (!unoccluded(world_, Vec3d(point), sample.wi, sample.distance))
      return Rgb();
    RatioTracking shadow(world_.medium, {{point, sample.wi}, 0, sample.distance});
    while (shadow.advance(rng))
      if (!shadow.attenuate(rng))
        break;
    return Rgb(shadow.transmittance());
  });
}

Rgb SceneTracer::lights_at_surface(const SurfaceVertex& vertex, Rng& rng) const {
  const auto scatter = [&](const Vec3f& wi) {
    return std::pair(vertex.evaluate(wi), vertex.pdf(wi));
  };
  return sample_lights(
      Vec3f(vertex.hit().position), rng, scatter, [&](const IncidentSample& sample) {
        const Vec3d origin = vertex.hit().leave(sample.wi);
        if (!unoccluded(world_, origin, sample.wi, sample.distance))
          return Rgb();
        return Rgb(
            exact_transmittance(world_.medium, {{Vec3f(origin), sample.wi}, 0, sample.distance}));
      });
}

/// The lights that the flight meets up to t_end but for surfaces, weighted against next-event
/// estimation.
Rgb SceneTracer::lights_met(const Path& path, float t_end) const {
  const Ray ray = path.ray();
  Rgb sum;
  for (std::size_t i = 0; i < world_.lights.size(); ++i) {
    const Light& light = world_.lights[i];
    if (light.is_delta() || light.surface() >= 0 || (path.leaves_out_sampled() && shadow_rays_[i]))
      continue;
    float weight = 1;
    if (shadow_rays_[i] && path.pdf > 0)
      weight = path.pdf / (path.pdf + light.incident_pdf(ray.origin, ray.direction));
    sum += light.emitted_radiance({ray, 0, t_end}).radiance * weight;
  }
  return sum;
}

} // namespace vdbeam
