#pragma once

#include "lights/light.h"
#include "lights/light_context.h"
#include "lights/local_aim.h"

namespace vdbeam {

/// Base of point and spot lights: a position, an intensity, and a factor that depends on direction.
/// Positions are kept in double precision, since a light may be far away.
class LocalLight : public Light {
public:
  IncidentSample sample_incident(const Vec3f& point, float u, float v) const override;
  float typical_intensity() const override { return max_component(Rgb(intensity_)); }
  float incident_pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  LightHit emitted_radiance(const Segment&) const override { return {}; }
  EmittedPhoton emit(double place, Rng& rng) const override;
  bool is_delta() const override { return true; }
  const Vec3d* position() const override { return &position_; }

protected:
  /// Photons leave within `emission_cone`, which must contain every direction in which the light
  /// emits and reaches the region.
  LocalLight(const LightSettings& settings, const LightContext& context, const Cone& emission_cone);

  /// Factor of the intensity along `direction`, per channel.
  virtual Vec3d share(const Vec3d& direction) const = 0;

  /// A direction for a photon, and the reciprocal of the density with which it was drawn [sr].
  struct Drawn {
    Vec3d direction;
    double solid_angle;
  };
  /// Evenly in the emission cone. `place` as in Light::emit, `v` uniform in [0, 1).
  virtual Drawn draw(double place, float v) const;

  static Vec3d render_position(const LightSettings& settings, const LightContext& context) {
    return context.space.point(settings.position);
  }
  const Vec3d& intensity() const { return intensity_; } ///< render units
  const Cone& emission_cone() const { return cone_; }

private:
  Vec3d position_;
  Vec3d intensity_;
  Cone cone_;
  OccupiedRegion sphere_; ///< centre and radius alone
};

} // namespace vdbeam
