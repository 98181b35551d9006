#pragma once

// What tests of surfaces begin with.
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam::test::surfaces {

using test::expect_mean;
using test::expect_power;
using test::MemoryScene;
using test::PassMeans;
using test::regions_apart;
using test::render_passes;
using test::Samples;

/// The scene's light is the same by paths and by `beam`, with single scattering by shadow rays and
/// by photons: no region of the image differs by more than 3 percent.
inline void expect_beam_agrees_with_path(MemoryScene scene) {
  const PassMeans path = render_passes(scene, EstimatorType::path, 400);
  for (const DirectLight direct : {DirectLight::sampled, DirectLight::photons}) {
    scene.scene.render.direct = direct;
    const PassMeans beam = render_passes(scene, EstimatorType::beam, 48);
    EXPECT_EQ(regions_apart(beam, path, 0.03), 0)
        << beam.total[0].mean() << " against " << path.total[0].mean();
    expect_power(path.total[0], 0.02 * path.total[0].mean());
    expect_power(beam.total[0], 0.03 * beam.total[0].mean());
  }
}

} // namespace vdbeam::test::surfaces
