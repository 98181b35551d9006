#include "cli/commands.h"

#include <array>

namespace vdbeam::cli {

std::span<const Command> commands() {
  static constexpr std::array<Command, 11> table{{
      {"render", "Render a scene or a VDB to EXR", add_render},
      {"info", "Describe volumes, meshes and images, and report problems", add_info},
      {"live", "Show a scene while it is edited", add_live},
      {"init", "Write a commented scene file for a VDB", add_init},
      {"plan", "Show features, passes and memory of a frame without rendering it", add_plan},
      {"compare", "Measure the error of an image against a reference", add_compare},
      {"merge", "Join partial images of one frame, bit for bit", add_merge},
      {"summary", "Make an HTML page of batches: film, errors, seconds, failures", add_summary},
      {"farm", "Write a job file for a render farm", add_farm},
      {"help", "Describe a command or a table of a scene file", add_help},
      {"generate", "Write the manual page, a shell's completion or the tables of keys",
       add_generate},
  }};
  return table;
}

} // namespace vdbeam::cli
