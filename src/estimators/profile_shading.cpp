#include "estimators/profile_shading.h"

#include "transport/emission.h"

namespace vdbeam {

void shade_profile(const World& world, const CameraRay& camera, const DepthProfile& profile,
                   std::size_t pixel, PassImage& image, std::uint64_t& emission_rays) {
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
  if (!image.emission.empty() && camera.t_begin < camera.t_end) {
    ++emission_rays;
    image.emission[pixel] = emission_along(world.medium, camera.ray, profile, camera.t_begin,
                                           camera.t_end, static_cast<float>(world.settings.cutoff));
  }
}

} // namespace vdbeam
