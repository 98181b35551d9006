#pragma once

#include "lights/light.h"

#include <memory>
#include <vector>

namespace vdbeam {

/// A light whose photons are aimed at several targets, one within the other: nests of the medium,
/// the medium, what stands about it, and so on to all that stands in the scene. Few photons go to a
/// wide ground or a wide layer of fog then, however wide it is, and each of them brings much.
///
/// An aim is the same light, made for the target alone. What it sends may meet a target before its
/// own, which is then another aim's: such a photon does not count (EmittedPhoton::first_target). So
/// every line of light belongs to one aim, and its density is that of one strategy.
class AimedLight final : public Light {
public:
  struct Aim {
    std::unique_ptr<const Light> light;
    int first_target, last_target; ///< that its photons count for
    double share;                  ///< of the photons, > 0; they add up to 1
  };
  /// The aims at nests come first, then that at the medium, `medium_aim`, which stands for the
  /// light in all else.
  AimedLight(std::vector<Aim> aims, std::size_t medium_aim);

  IncidentSample sample_incident(const Vec3f& point, float u, float v) const override {
    return light().sample_incident(point, u, v);
  }
  IncidentSample typical_incident(const Vec3f& point) const override {
    return light().typical_incident(point);
  }
  float typical_intensity() const override { return light().typical_intensity(); }
  float incident_pdf(const Vec3f& point, const Vec3f& wi) const override {
    return light().incident_pdf(point, wi);
  }
  LightHit emitted_radiance(const Segment& segment) const override {
    return light().emitted_radiance(segment);
  }
  bool has_extent() const override { return light().has_extent(); }
  EmittedPhoton emit(double place, Rng& rng) const override;
  Rgb power() const override { return power_; }
  Rgb power_into_nest() const override {
    return medium_aim_ > 0 ? aims_[0].light->power() : power_;
  }
  bool is_delta() const override { return light().is_delta(); }
  const Vec3d* position() const override { return light().position(); }
  Segment lit_part(const Segment& segment) const override { return light().lit_part(segment); }
  const Vec3f* narrow_direction() const override { return light().narrow_direction(); }
  int surface() const override { return light().surface(); }
  float surface_pdf(const SurfaceHit& hit, const Vec3f& wi) const override {
    return light().surface_pdf(hit, wi);
  }

private:
  const Light& light() const { return *aims_[medium_aim_].light; }

  std::vector<Aim> aims_;
  std::size_t medium_aim_;
  Rgb power_;
  std::vector<float> fluxes_to_medium_; ///< of a photon of each aim up to that at the medium
};

} // namespace vdbeam
