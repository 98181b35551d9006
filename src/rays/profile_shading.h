#pragma once

#include "math/grouped_light.h"
#include "medium/depth_profile.h"
#include "rays/caught_shadow.h"
#include "rays/estimator_input.h"
#include "transport/camera_ray.h"

#include <functional>

namespace vdbeam {

/// Numbers of samples of a matt surface's light.
struct MattSamples {
  int paths = 0;       ///< that go on from there
  int shadow_rays = 0; ///< sets of one to each light, the paths' own among them

  /// The fewest that show how much the shadow rays vary.
  static constexpr MattSamples fewest() { return {1, 2}; }
};

/// Light of the surface at the end of a camera ray.
struct SeenSurface {
  GroupedLight radiance = {}; ///< that leaves it against the ray
  CaughtShadow caught = {};   ///< on a shadow catcher; nothing else of it is visible
  Rgb added = {}; ///< radiance that leaves a shadow catcher by light that the plate does not have
  /// The part of `radiance` that the surface emits, as a light with shadow rays.
  GroupedLight lamp = {};
  // For a surface that is not specular:
  /// The part of `radiance` that comes by way of other surfaces and the medium and that the matt
  /// part of the material reflects, per albedo.
  GroupedLight smooth = {};
  /// The part that shadow rays from the surface find and that the matt part of the material
  /// reflects, per albedo, and the variance of this mean over them, mean of channels.
  GroupedLight straight = {};
  float straight_variance = 0;
  /// The part that the rest of the material reflects, from either source, per `gloss_color`, and
  /// the variance of this mean.
  GroupedLight gloss = {};
  float gloss_variance = 0;
  /// Paths of `smooth` and `gloss`, and shadow rays of `straight`; 0: no more may be added.
  MattSamples samples = {};
  Rgb albedo = {};          ///< of the matt part; 1 where there is none
  Rgb gloss_color = Rgb(1); ///< of a texture that multiplies all that is reflected
  Vec3f position = {};      ///< render space
  Vec3f normal = {};        ///< on the side that is seen
  int surface = -1;         ///< -1: the light is not fitted

  /// The part of `radiance` that is fitted over pixels.
  GroupedLight fitted() const { return (smooth + straight) * albedo + gloss * gloss_color; }
};

/// Contribution of a ray to PassImage::opacity and PassImage::depth.
struct OpacityAndDepth {
  float opacity = 0, depth = 0;
};

/// Those of the medium alone; the profile may be empty.
OpacityAndDepth opacity_and_depth(const World& world, const CameraRay& camera,
                                  const DepthProfile& profile);

/// The parts of a pixel that follow from a depth profile alone: opacity, depth, and the lights seen
/// through the medium. They are added to what other rays gave the pixel. `surface`: what is seen of
/// the surface at which the ray ends, if it does. Returns opacity and depth of the medium alone.
OpacityAndDepth shade_profile(const EstimatorInput& input, const CameraRay& camera,
                              const DepthProfile& profile, std::size_t pixel, PassImage& image,
                              const SeenSurface& surface = {});

/// Adds the emission of the world's medium, to which the profile belongs. Counts a ray in
/// `emission_rays` where emission was integrated.
void shade_emission(const EstimatorInput& input, const World& world, const CameraRay& camera,
                    const DepthProfile& profile, std::size_t pixel, PassImage& image,
                    std::uint64_t& emission_rays);

/// The lights that a ray meets on `segment`, seen through the medium, whose transmittance all along
/// is `tr`. `camera`: only those that the camera sees. `weight`, if given: factor of each light.
GroupedLight lights_through(const World& world, const Segment& segment, const DepthProfile& profile,
                            const Rgb& tr, bool camera,
                            const std::function<float(std::size_t light)>& weight = {});

/// exp(-tau) all along the profile.
Rgb transmittance(const Medium& medium, const DepthProfile& profile);

} // namespace vdbeam
