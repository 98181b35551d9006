#include "estimators/profile_shading.h"

namespace vdbeam {

void shade_profile(const World& world, const CameraRay& camera, const DepthProfile& profile,
                   std::size_t pixel, PassImage& image) {
  Rgb tr(1);
  if (!profile.empty()) {
    const Rgb tau = profile.channels(world.medium, profile.knots() - 1);
    tr = {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
    // Not 1 - tr, which has no digits left where the medium is thin.
    const float opacity =
        -mean_component(Rgb(std::expm1(-tau.x), std::expm1(-tau.y), std::expm1(-tau.z)));
    image.opacity[pixel] = opacity;
    image.depth[pixel] =
        static_cast<float>((profile.opacity_depth() + camera.shift * opacity) / world.space.scale);
  }
  image.background[pixel] = tr * world.lights.escaped_radiance(camera.ray.direction);
}

} // namespace vdbeam
