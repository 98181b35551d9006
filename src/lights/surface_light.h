#pragma once

#include "geometry/surface_set.h"
#include "lights/light.h"

#include <memory>

namespace vdbeam {

/// A surface that shines: the same radiance in all directions, from its front or from both sides.
/// Points on it are drawn uniformly by area; its photons leave by Lambert's cosine law.
class SurfaceLight final : public Light {
public:
  SurfaceLight(std::shared_ptr<const SurfaceSet> surfaces, int surface, const Rgb& radiance,
               bool two_sided);

  IncidentSample sample_incident(const Vec3f& point, float u, float v) const override;
  float incident_pdf(const Vec3f& point, const Vec3f& wi) const override;
  LightHit emitted_radiance(const Segment& segment) const override;
  bool has_extent() const override { return true; }
  EmittedPhoton emit(double place, Rng& rng) const override;
  Rgb power() const override { return power_; }
  bool is_delta() const override { return false; }
  const Vec3d* position() const override { return &center_; }
  int surface() const override { return surface_; }
  float surface_pdf(const SurfaceHit& hit, const Vec3f& wi) const override;

private:
  bool shines(const Vec3f& normal, const Vec3f& away) const {
    return two_sided_ ? dot(normal, away) != 0 : dot(normal, away) > 0;
  }

  std::shared_ptr<const SurfaceSet> surfaces_;
  int surface_;
  Rgb radiance_;
  bool two_sided_;
  Vec3d center_;
  Rgb power_;
};

} // namespace vdbeam
