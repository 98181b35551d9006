#pragma once

#include "math/ray.h"
#include "math/rng.h"
#include "vdbeam/scene.h"

#include <span>

namespace vdbeam {

struct SurfaceHit;

/// Light arriving at a point, drawn by `Light::sample_incident`.
struct IncidentSample {
  Vec3f wi;           ///< unit, from the point towards the light
  float distance = 0; ///< to the light, infinity for distant ones
  Rgb value;          ///< radiance / pdf; for a delta light irradiance perpendicular to wi
  float pdf = 0;      ///< per solid angle; 0 for a delta light (no other strategy can hit it)
};

/// Where a ray meets a light.
struct LightHit {
  Rgb radiance;              ///< that leaves the light against the ray; 0: it is not met
  float distance = infinity; ///< infinity: beyond the scene
};

/// A photon as it leaves a light, already at the edge of the occupied region.
struct EmittedPhoton {
  Ray ray;
  Rgb flux; ///< emitted power / density; the mean over photons is the light's power into the region
  /// Where the light is aimed at several targets (AimedLight): those that the photon counts for, if
  /// its ray meets none before them.
  int first_target = 0, last_target = 0;
  /// Flux of such a light's photons to each nest of the medium and to the medium, in the strongest
  /// channel; empty: of any other light.
  std::span<const float> fluxes_to_medium = {};
};

/// A light in render space. All quantities that depend on length are converted when it is made.
class Light {
public:
  virtual ~Light() = default;

  /// One direction to the light for a shadow ray. value is 0 where no light arrives.
  virtual IncidentSample sample_incident(const Vec3f& point, float u, float v) const = 0;
  /// The direction of a lamp and its irradiance, if nothing is in between: about what a vertex that
  /// cannot look for all lamps expects of this one. Its value is 0 only if no light arrives.
  virtual IncidentSample typical_incident(const Vec3f& point) const {
    return sample_incident(point, 0.5f, 0.5f);
  }
  /// The intensity of a lamp, whatever the direction, > 0 unless it is dark; 0 for other lights.
  virtual float typical_intensity() const { return 0; }
  /// Density with which sample_incident draws `wi`; 0 for delta lights.
  virtual float incident_pdf(const Vec3f& point, const Vec3f& wi) const = 0;
  /// The light as a ray meets it between the segment's ends, whatever else is in the way; never met
  /// are delta lights. Lights do not stop a ray: what lies behind them is seen too.
  virtual LightHit emitted_radiance(const Segment& segment) const = 0;
  /// True where a ray may meet the light at a finite distance.
  virtual bool has_extent() const { return false; }
  /// One photon aimed at the occupied region. `place`, uniform in [0, 1), says where it starts:
  /// in equal steps over a light's photons it stratifies them, and consecutive photons start side
  /// by side and read the same bricks, which keeps these in cache. The rest is drawn from rng.
  virtual EmittedPhoton emit(double place, Rng& rng) const = 0;
  EmittedPhoton emit(Rng& rng) const {
    const double place = rng.uniform();
    return emit(place, rng);
  }
  /// Power into the occupied region (render units), to share photons between lights.
  virtual Rgb power() const = 0;
  /// The same into the smallest nest of the medium, where it has any.
  virtual Rgb power_into_nest() const { return power(); }
  /// True where only sample_incident can find the light.
  virtual bool is_delta() const = 0;
  /// Where a local light stands, in render space; null for lights at infinity.
  virtual const Vec3d* position() const { return nullptr; }
  /// Its light has no bound near it, so that what the medium scatters there is left to photons.
  bool is_near() const { return position() || surface() >= 0; }
  /// The part of a segment that the light can reach; the whole segment if unknown.
  virtual Segment lit_part(const Segment& segment) const { return segment; }
  /// Unit, towards a light at infinity that fills a small part of the sky; null for any other.
  virtual const Vec3f* narrow_direction() const { return nullptr; }
  /// The surface that shines; -1 for lights that are none. Rays meet it as they meet any surface.
  virtual int surface() const { return -1; }
  /// Density per solid angle with which sample_incident, asked at the origin of a ray of direction
  /// `wi`, draws the point of the light's surface that the ray meets.
  virtual float surface_pdf(const SurfaceHit&, const Vec3f&) const { return 0; }
};

} // namespace vdbeam
