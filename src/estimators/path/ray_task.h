#pragma once

#include "estimators/path/path.h"

// What the parts of PathEstimator share; only its own files include this.

namespace vdbeam {

struct PathEstimator::RayTask {
  RayTask(const World& world, const CameraRay& camera_, const DepthProfile& profile_,
          const RngKey& key_, std::size_t pixel_, std::size_t target_, const PathEffort& effort_)
      : camera(camera_), profile(profile_), key(key_), pixel(pixel_), target(target_),
        effort(effort_), transmitted(transmittance(world.medium, profile_)) {
    if (!profile.empty())
      opacity = opacity_of(max_component(profile.channels(world.medium, profile.knots() - 1)));
  }

  const CameraRay& camera;
  const DepthProfile& profile;
  RngKey key;         ///< of the random numbers
  std::size_t pixel;  ///< of the picture
  std::size_t target; ///< pixel of the image to which its light is added
  PathEffort effort;
  Rgb transmitted;   ///< of the light from the end of the ray
  float opacity = 0; ///< of the medium, in the channel with most

  /// What the part can contribute to the ray.
  float share(PathPart part) const {
    if (part == PathPart::surface)
      return camera.hit ? max_component(transmitted) : 0;
    return opacity;
  }
  PartDraws draws_of(PathPart part, float u) const { return effort.draws_of(part, share(part), u); }
};

/// Buffers that a thread keeps from pixel to pixel.
struct PathEstimator::Scratch {
  DepthProfile profile;
  std::vector<PathWalk> walks;
  std::vector<PathWalk> branches; ///< of the present round
  RenderStatistics counts;
  /// Steps after which walks end, which is right in a pilot only.
  std::uint32_t most_rounds = ~std::uint32_t(0);
};

} // namespace vdbeam
