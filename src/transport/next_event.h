#pragma once

#include "transport/world.h"

#include <concepts>
#include <optional>

namespace vdbeam {

/// A vertex of a path: where it is, where a ray begins that leaves it in the direction wi, and how
/// much it scatters there. On surfaces it is a SurfaceVertex, in the medium one of those below.
template <class Vertex>
concept PathVertex = requires(const Vertex& vertex, const Vec3f& wi) {
  { vertex.position() } -> std::convertible_to<Vec3f>;
  { vertex.leave(wi) } -> std::convertible_to<Vec3d>;
  { vertex.evaluate(wi) } -> std::convertible_to<Rgb>;
};

/// A vertex in a volume, by its phase function.
struct MediumVertex {
  const Vec3f& point;
  const Vec3f& arriving; ///< unit, along which the path comes
  const PhaseFunction& phase;

  const Vec3f& position() const { return point; }
  Vec3d leave(const Vec3f&) const { return Vec3d(point); }
  Rgb evaluate(const Vec3f& wi) const { return Rgb(phase.evaluate(dot(arriving, wi))); }
};

/// A point that shows all light that it gets.
struct AnyVertex {
  const Vec3f& point;

  const Vec3f& position() const { return point; }
  Vec3d leave(const Vec3f&) const { return Vec3d(point); }
  Rgb evaluate(const Vec3f&) const { return Rgb(1); }
};

/// Light that a shadow ray brings from a light to a vertex of a path.
struct ShadowRay {
  Rgb light;       ///< radiance of the light over the density with which the direction was drawn
  Rgb scattered;   ///< factor by which the vertex scatters it on: p, or f |cos|
  float weight;    ///< against drawing the direction as the path goes on (balance heuristic)
  Segment segment; ///< from the vertex to the light

  const Vec3f& direction() const { return segment.ray.direction; }
  /// What the vertex scatters on, but for the transmittance of the segment.
  Rgb radiance() const { return light * (scattered * weight); }
};

/// Next-event estimation of all walks and of direct_light: draws a shadow ray from a vertex in the
/// medium or on a surface to a light. None where no light comes from there, a surface hides it, or
/// the vertex scatters none of it. pdf(wi): the density [1/sr] with which the path itself draws the
/// direction wi to go on, 0 where the light is found in no other way. The two are combined by
/// multiple importance sampling (Veach and Guibas 1995). The transmittance of the segment is left
/// to the caller: estimated at once, or a collision at a time beside other walks.
template <PathVertex Vertex, class Pdf>
std::optional<ShadowRay> sample_direct_light(const World& world, const Light& light,
                                             const Vertex& vertex, Rng& rng, const Pdf& pdf) {
  const float u = rng.uniform(), v = rng.uniform();
  const IncidentSample sample = light.sample_incident(vertex.position(), u, v);
  if (!(max_component(sample.value) > 0))
    return std::nullopt;
  const Vec3f& wi = sample.wi;
  const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + pdf(wi)) : 1;
  const Rgb scattered = vertex.evaluate(wi);
  if (scattered == Rgb() || !(weight > 0)) // a truncated phase function may be negative
    return std::nullopt;
  const Vec3d origin = vertex.leave(wi);
  if (!unoccluded(world, origin, wi, sample.distance))
    return std::nullopt;
  return ShadowRay{sample.value, scattered, weight, {{Vec3f(origin), wi}, 0, sample.distance}};
}

/// The same for lights that paths find in no other way.
template <PathVertex Vertex>
std::optional<ShadowRay> sample_direct_light(const World& world, const Light& light,
                                             const Vertex& vertex, Rng& rng) {
  return sample_direct_light(world, light, vertex, rng, [](const Vec3f&) { return 0.0f; });
}

} // namespace vdbeam
