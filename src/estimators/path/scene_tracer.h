#pragma once

#include "medium/flight.h"
#include "transport/world.h"

namespace vdbeam {

/// Radiance by what the light did in the medium.
struct ScatteredLight {
  Rgb direct;   ///< was scattered once there
  Rgb indirect; ///< was scattered more often
};

/// Unbiased path tracing among surfaces and media: flights by delta tracking end at surfaces, which
/// scatter by their materials; next-event estimation at every vertex that is not specular, through
/// the medium's transmittance, combined with the directions drawn by multiple importance sampling
/// (balance heuristic, Veach and Guibas 1995); Russian roulette. Light of point lights, or of a
/// parallel sun, that only mirrors or glass bring to a point is not found: no path meets them.
///
/// Scenes without surfaces are traced by WalkTracer. Requires a world with surfaces.
class SceneTracer {
public:
  /// `shadow_rays`: per light, whether next-event estimation samples it.
  /// `max_bounces`: scattering events in the medium.
  SceneTracer(const World& world, std::vector<bool> shadow_rays, std::optional<int> max_bounces)
      : world_(world), shadow_rays_(std::move(shadow_rays)), max_bounces_(max_bounces) {}

  /// Radiance that leaves a surface against `direction`, along which a camera ray meets it.
  /// `all_light`: or without what a light with shadow rays sends first to mirrors, metal, glass or
  /// the medium, and they on to other surfaces, to which photons bring it.
  /// `emitted`: factor of what the surface itself emits.
  Rgb from_surface(const SurfaceHit& hit, const Vec3f& direction, Rng& rng, bool all_light = true,
                   float emitted = 1) const;

  /// Light of a path that scatters first at ray.origin, coming along ray.direction, but for what
  /// comes there straight from lights with shadow rays (direct_light).
  ScatteredLight from_medium(const Ray& ray, const Rgb& throughput, const PhaseFunction& phase,
                             Rng& rng) const;

  /// Next-event estimation at a surface that is not specular: what it reflects of the lights with
  /// shadow rays, weighted against the direction that `vertex` draws (balance heuristic).
  Rgb lights_at_surface(const SurfaceVertex& vertex, Rng& rng) const;
  bool samples_light(std::size_t light) const { return shadow_rays_[light]; }

private:
  struct Path;

  void follow(Path& path) const;
  bool fly(Path& path, float t_end, float medium_end, Collision& hit) const;
  bool collide(Path& path, const Collision& hit) const;
  bool bounce(Path& path, const SurfaceVertex& vertex) const;
  template <class Scatter, class Transmittance>
  Rgb sample_lights(const Vec3f& point, Rng& rng, const Scatter& scatter,
                    const Transmittance& transmittance) const;
  Rgb lights_at_collision(const Path& path, const Vec3f& point, const PhaseFunction& phase,
                          Rng& rng) const;
  Rgb lights_met(const Path& path, float t_end) const;

  const World& world_;
  std::vector<bool> shadow_rays_;
  std::optional<int> max_bounces_;
};

} // namespace vdbeam
