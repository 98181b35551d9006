#pragma once

#include "keys/scene_keys.h"
#include "support/test_frame.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vdbeam::test {

/// A small box of a medium below a light.
inline MemoryScene lit_by(const LightType& type, float intensity) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box(Vec3d(-0.5), Vec3d(0.5));
  volume.extinction = 2;
  LightSettings& light = scene.add_light(type);
  light.position = {0, 2, 0};
  light.intensity = Rgb(intensity);
  scene.look({0, 0, 3}, {0, 0, 0}, 20, 8, 8);
  scene.scene.render.photons = 2000;
  return scene;
}

inline const SceneKey& key(SceneSection section, const std::string& name) {
  const SceneKey* found = find_key(section, name);
  if (!found)
    throw InputError("there is no key " + name);
  return *found;
}

inline bool holds(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// What validation finds wrong with a scene; empty: nothing.
inline std::string complaint_about(const Scene& scene) {
  try {
    validate_scene(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// The first pass of a scene by an estimator.
inline PassImage first_pass(MemoryScene scene, const EstimatorType& type) {
  scene.scene.render.estimator = type;
  const TestFrame frame(scene);
  PassImage image;
  RenderStatistics statistics;
  frame.estimator()->render_pass(0, image, statistics);
  return image;
}

/// Two ways to write a scene are the same picture, which is not black.
inline void expect_same_picture(const MemoryScene& a, const MemoryScene& b) {
  for (const EstimatorType& type :
       {EstimatorType::beam, EstimatorType::gather, EstimatorType::march, EstimatorType::path}) {
    const PassImage first = first_pass(a, type), second = first_pass(b, type);
    EXPECT_GT(mean_component(first.total(27)), 0) << type.name;
    EXPECT_EQ(first.direct, second.direct) << type.name;
    EXPECT_EQ(first.indirect, second.indirect) << type.name;
  }
}

} // namespace vdbeam::test
