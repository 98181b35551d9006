#include "console/terminal.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace vdbeam::cli {

bool is_smart_terminal(int descriptor) {
  const char* const type = std::getenv("TERM");
  return isatty(descriptor) != 0 && type && *type && std::string_view(type) != "dumb";
}

int terminal_columns(int descriptor) {
  winsize size{};
  constexpr int usual = 80;
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

std::size_t text_columns() {
  constexpr int fewest = 80, most = 120;
  return static_cast<std::size_t>(std::clamp(terminal_columns(STDOUT_FILENO), fewest, most));
}

std::string error_line(const std::string& line) {
  const char* const no_color = std::getenv("NO_COLOR");
  if ((no_color && *no_color) || !is_smart_terminal(STDERR_FILENO))
    return line;
  return "\x1b[31m" + line + "\x1b[0m";
}

} // namespace vdbeam::cli
