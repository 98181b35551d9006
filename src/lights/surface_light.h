#pragma once

#include "geometry/surface_set.h"
#include "lights/emission_cells.h"
#include "lights/light.h"
#include "lights/occupied_region.h"
#include "lights/solid_angle.h"

#include <memory>

namespace vdbeam {

/// A surface that shines: the same radiance in all directions, from its front or from both sides.
/// Points on balls and rectangles are drawn uniformly by solid angle, on others by area, under a
/// picture by what it shows there; photons leave by Lambert's cosine law.
class SurfaceLight final : public Light {
public:
  /// `seen_as`: what the surface is, where it can be drawn by solid angle; `texture`, unless it is
  /// null: the picture that the radiance is multiplied by; `target`, unless it is null: the region
  /// to which photons are sent, the others are left out.
  SurfaceLight(std::shared_ptr<const SurfaceSet> surfaces, int surface, const Rgb& radiance,
               bool two_sided, const SolidAngleShape& seen_as = {},
               std::shared_ptr<const Texture> texture = nullptr,
               const OccupiedRegion* target = nullptr);

  IncidentSample sample_incident(const Vec3f& point, float u, float v) const override;
  IncidentSample typical_incident(const Vec3f& point) const override;
  float typical_intensity() const override { return max_component(intensity_); }
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
  /// A point drawn by area, or by the picture.
  SurfacePoint sample_area(double place, double u, double v) const;
  /// The density per area with which the latter draws a point.
  float area_pdf(std::size_t primitive, const Vec3d& position, const Vec3f& normal) const;
  IncidentSample sample_by_area(const Vec3f& point, double place, double u, double v) const;
  /// Half of the points by solid angle, where they can be, half by the picture.
  IncidentSample sample_textured(const Vec3f& point, float u, float v) const;
  Rgb radiance(const Uv& uv) const { return texture_ ? radiance_ * texture_->at(uv) : radiance_; }
  std::optional<SolidAnglePoint> sample_solid_angle(const Vec3d& point, float u, float v) const;
  /// Solid angle from `point`; 0 if points on it are drawn by area.
  double solid_angle(const Vec3d& point) const;
  /// A direction for a photon from a point, and pi times its cosine over its density.
  Vec3f sample_leaving(const SurfacePoint& from, Rng& rng, float& weight) const;
  bool shines(const Vec3f& normal, const Vec3f& away) const {
    return two_sided_ ? dot(normal, away) != 0 : dot(normal, away) > 0;
  }

  std::shared_ptr<const SurfaceSet> surfaces_;
  int surface_;
  Rgb radiance_;
  bool two_sided_;
  SolidAngleShape seen_as_;
  std::shared_ptr<const Texture> texture_;
  std::optional<EmissionCells> cells_; ///< where there is a texture
  Vec3d center_;
  double size_squared_;   ///< of half the diagonal of the surface's bounds
  Rgb intensity_;         ///< of the whole surface, seen at right angles
  OccupiedRegion target_; ///< without boxes; of no radius: all that it shines on
  Rgb power_;
};

} // namespace vdbeam
