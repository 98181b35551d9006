#pragma once

#include "vdbeam/render_plan.h"
#include "vdbeam/scene.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// What a part of a render takes in memory [bytes], in each phase of a frame.
struct PlannedMemory {
  std::string name;
  std::uint64_t reading = 0;   ///< while volumes and surfaces are read and prepared
  std::uint64_t rendering = 0; ///< in a pass
  std::uint64_t writing = 0;   ///< while the picture is written
};

/// The memory that a frame takes, estimated before it is rendered: what a control group counts of
/// the program and its reader processes together [bytes].
struct MemoryPlan {
  std::vector<PlannedMemory> parts;
  std::uint64_t reading = 0, rendering = 0, writing = 0; ///< sums of the parts
  std::uint64_t program = 0; ///< the part that is there before anything is read
  std::uint64_t kept = 0;    ///< volumes, from when they are read to the end of the frame
  std::uint64_t film = 0;    ///< what a merge of partial images takes twice
  /// What needs most memory, a file or a key of the scene, and how to do with less.
  std::string largest_part, remedy;

  std::uint64_t peak() const { return std::max({reading, rendering, writing}); }
  /// The peak where the next frame, one like this, is read while this one is rendered.
  std::uint64_t peak_reading_ahead() const {
    return std::max(peak(), std::max(rendering, writing) + reading - program);
  }
};

/// Estimates a frame's memory from its settings and the topology of its volumes' trees; reads no
/// voxels. `references`: images that its passes are compared with. Throws InputError and FrameError
/// as reading the files does.
MemoryPlan plan_memory(const Scene& scene, int references = 0);

} // namespace vdbeam
