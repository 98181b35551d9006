#pragma once

#include "support/temp_folder.h"
#include "vdbeam/render.h"

#include <string>
#include <utility>
#include <vector>

namespace vdbeam::test {

/// First and last pass of a part of a frame.
using PartPasses = std::pair<int, int>;

/// Renders parts of a frame into files of the folder, in the order given; returns their paths.
inline std::vector<std::string> render_parts(const Scene& scene, const TempFolder& folder,
                                             const std::vector<PartPasses>& parts,
                                             FrameSettings frame = {}) {
  std::vector<std::string> paths;
  for (const auto& [first, last] : parts) {
    frame.pass_range = PassRange{first, last};
    frame.partial = folder.file(std::to_string(first) + ".exr");
    render(scene, frame);
    paths.push_back(frame.partial);
  }
  return paths;
}

} // namespace vdbeam::test
