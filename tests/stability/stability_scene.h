#pragma once

#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

namespace vdbeam::test {

/// Every pixel of every channel is finite and not negative; `what` names the image in messages.
inline void expect_sound(const PassMeans& means, const std::string& what) {
  for (std::size_t i = 0; i < means.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = means.pixels[i][c];
      ASSERT_TRUE(std::isfinite(value)) << what << ": pixel " << i << " is " << value;
      ASSERT_GE(value, 0) << what << ": pixel " << i;
    }
}

/// Renders passes of a scene in memory and expects sound pixels.
inline PassMeans render_sound(const MemoryScene& scene, EstimatorType type, int passes,
                              const std::string& what) {
  PassMeans means = render_passes(scene, type, passes);
  expect_sound(means, what);
  return means;
}

/// A box of side 1 around the origin, seen by a camera in front of it that sees nothing else.
inline MemoryScene box_scene(double extinction, double albedo = 1) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  volume.extinction = extinction;
  volume.albedo = Rgb(static_cast<float>(albedo));
  scene.look({0, 0, 3}, {0, 0, 0}, 12, 8, 8);
  return scene;
}

inline LightSettings& add_sky(MemoryScene& scene, float radiance = 1) {
  LightSettings& light = scene.add_light(LightType::environment);
  light.radiance = Rgb(radiance);
  return light;
}

inline LightSettings& add_sun(MemoryScene& scene, const Vec3d& direction, float irradiance = 1) {
  LightSettings& light = scene.add_light(LightType::distant);
  light.direction = direction;
  light.irradiance = Rgb(irradiance);
  return light;
}

/// An estimator's name, for parametrised tests and messages.
inline std::string name_of(const EstimatorType& type) {
  return std::string(type.name);
}

} // namespace vdbeam::test
