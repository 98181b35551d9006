#pragma once

#include "vdbeam/render_plan.h"
#include "vdbeam/scene.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// Memory of a part of a render [bytes] in each phase of a frame.
struct PlannedMemory {
  std::string name;
  std::uint64_t reading = 0;   ///< while volumes and surfaces are read and prepared
  std::uint64_t rendering = 0; ///< in a pass
  std::uint64_t writing = 0;   ///< while the image is written
};

/// Estimated memory of a frame [bytes], as a control group counts it for the program and its reader
/// processes together.
struct MemoryPlan {
  std::vector<PlannedMemory> parts;
  std::uint64_t reading = 0, rendering = 0, writing = 0; ///< sums of the parts
  std::uint64_t program = 0; ///< memory of the program before anything is read
  std::uint64_t kept = 0;    ///< volumes, from when they are read to the end of the frame
  std::uint64_t film = 0;    ///< a merge of partial images takes this twice
  /// The largest part, a file or a key of the scene, and a remedy.
  std::string largest_part, remedy;

  std::uint64_t peak() const { return std::max({reading, rendering, writing}); }
  /// The peak if a similar next frame is read while this one is rendered.
  std::uint64_t peak_reading_ahead() const {
    return std::max(peak(), std::max(rendering, writing) + reading - program);
  }
};

/// Estimates a frame's memory from its settings and the topology of its volumes' trees; reads no
/// voxels. `references`: images that its passes are compared with. Throws InputError and FrameError
/// as reading the files does.
MemoryPlan plan_memory(const Scene& scene, int references = 0);

} // namespace vdbeam
