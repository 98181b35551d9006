#pragma once

#include "lights/light.h"
#include "volume/emitter.h"

namespace vdbeam {

/// A glowing volume as a light: its photons start where it glows, in proportion to how brightly,
/// and leave in all directions. No shadow ray looks for it, and rays do not meet it as a light:
/// they gather what the medium emits along their way (medium/emission.h). To be added to a
/// LightSet with DirectLight::photons.
///
/// Its power is 4 pi times the integral of j over the volume, exact for the trilinear field.
class VolumeLight final : public Light {
public:
  explicit VolumeLight(const Emitter& emitter);

  IncidentSample sample_incident(const Vec3f&, float, float) const override {
    return {{0, 0, 1}, 0, {}, 0};
  }
  float incident_pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  LightHit emitted_radiance(const Segment&) const override { return {}; }
  EmittedPhoton emit(double place, Rng& rng) const override;
  Rgb power() const override { return power_; }
  bool is_delta() const override { return false; }

private:
  /// A cell that glows, and where its share of the light ends in the sum over cells.
  struct Cell {
    Vec3<int> place;
    double end = 0;
  };
  static constexpr int cubes = cell_width;
  static constexpr int cube_count = cubes * cubes * cubes;

  void sum_brick(std::int32_t brick);
  double cell_sum(std::int32_t entry) const;
  int find_cube(std::int32_t brick, float place, double& share) const;

  Emitter emitter_;
  double cube_volume_; ///< of one lattice cube, render units
  std::vector<Cell> cells_;
  std::vector<float> brick_sums_; ///< per brick the running sum over its cubes, z fastest
  Rgb power_;
};

} // namespace vdbeam
