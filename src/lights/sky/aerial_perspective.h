#pragma once

#include "lights/sky/ray_air.h"
#include "vdbeam/scene.h"
#include "volume/render_space.h"

#include <array>
#include <memory>
#include <vector>

namespace vdbeam {

/// The air of an atmosphere between the camera and what it sees: how much light it lets through,
/// and how much it adds, by line of sight and distance. Both are integrals of the model that the
/// sky is made from, so what is far away has the colour of the horizon.
///
/// Light is dimmed as that of the sun would be, per channel of the working space. Objects cast no
/// shadows into the air.
class AerialPerspective {
public:
  /// `settings`: of a light of the type `atmosphere` with `metres_per_unit`, whose altitude is the
  /// camera's; `up`: the camera's.
  AerialPerspective(const LightSettings& settings, const Vec3d& up, const RenderSpace& space);

  /// The air along a ray from the camera. `shift`: distance from the camera to where the ray's own
  /// distances begin, render units.
  RayAir along(const Vec3d& direction, double shift) const;

private:
  static constexpr int rows = 192, columns = 49, knots = 97;
  struct Tables;

  std::shared_ptr<const Tables> tables_;
  std::array<Vec3d, 3> axes_;
  double sun_turn_, metres_; ///< radians; per render unit
};

/// Number of the light with the air between camera and scene; -1: there is none.
int light_with_air(const std::vector<LightSettings>& lights);

/// The scene's lights; where one has the air between camera and scene, altitudes are those of the
/// camera, in steps of a metre or 1 %, so that a sky need not be computed for each of its moves.
std::vector<LightSettings> lights_at_camera(const Scene& scene);

} // namespace vdbeam
