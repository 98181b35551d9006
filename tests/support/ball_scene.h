#pragma once

#include "support/temp_folder.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace vdbeam::test {

/// Scenes with a ball of radius 0.9 about the origin that has a velocity of (1, 2, 3) world units
/// in a frame, in a sky that is hidden from the camera.
class BallTest : public ::testing::Test {
protected:
  /// 24 x 24 pixels of parallel rays along -Z, four to the world unit.
  static constexpr const char* parallel_rays =
      "position = [0, 0, 6]\nprojection = \"orthographic\"\nview_height = 6\n";

  BallTest() { write("staggered", "ball.vdb"); }
  /// Writes a volume of 24 voxels across.
  void write(const char* kind, const char* name) const {
    VolumeOptions options;
    options.size = 24;
    write_volume(kind, folder_.file(name), options);
  }
  /// `camera`: the keys of the section; `more`: overrides, which win.
  Scene load_ball(const std::string& camera, const std::vector<std::string>& more) const {
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = 24\nheight = 24\n[camera]\n"
        << camera
        << "\n[[volume]]\nfile = \"ball.vdb\"\nextinction = 0.5\nvelocity_fps = 1\n"
           "[[light]]\ntype = \"environment\"\nvisible = false\n"
           "[render]\npasses = 16\nestimator = \"path\"\n";
    return load_scene(folder_.file("s.toml"), 1, more);
  }
  /// A channel's values, row by row from the top.
  static const std::vector<float>& plane(const Image& image, const char* name) {
    return image.find(name)->data;
  }

  TempFolder folder_;
};

} // namespace vdbeam::test
