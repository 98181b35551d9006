#include "cli/commands.h"

#include <array>

namespace vdbeam::cli {

std::span<const Command> commands() {
  static constexpr std::array<Command, 9> table{{
      {"render", "Render a scene or a VDB to EXR", add_render},
      {"info", "Show what VDB files hold, what would be rendered, what looks wrong", add_info},
      {"init", "Write a commented scene file for a VDB", add_init},
      {"plan", "Show which stages a scene needs, which are left out and why", add_plan},
      {"compare", "Measure the error of an image against a reference", add_compare},
      {"merge", "Join partial images of one frame, bit for bit", add_merge},
      {"farm", "Write a job file for a render farm", add_farm},
      {"help", "Tell about a command", add_help},
      {"generate", "Write the manual page or a shell's completion", add_generate},
  }};
  return table;
}

} // namespace vdbeam::cli
