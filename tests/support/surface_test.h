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

} // namespace vdbeam::test::surfaces
