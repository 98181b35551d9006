#include "machine/command_line.h"

#include <fstream>

namespace vdbeam {

std::vector<std::string> command_line() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(stream, word, '\0');)
    words.push_back(word);
  return words;
}

} // namespace vdbeam
