#include "estimators/profile_shading.h"

namespace vdbeam {

void shade_profile(const World& world, const CameraRay& camera, const DepthProfile& profile,
                   std::size_t pixel, PassImage& image) {
  Rgb tr(1);
  if (!profile.empty()) {
    const Rgb tau = profile.channels(world.medium, profile.knots() - 1);
    tr = {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
    const float opacity = 1 - mean_component(tr);
    image.opacity[pixel] = opacity;
    image.depth[pixel] =
        static_cast<float>((profile.opacity_depth() + camera.shift * opacity) / world.space.scale);
  }
  image.background[pixel] = tr * world.lights.escaped_radiance(camera.ray.direction);
}

} // namespace vdbeam
