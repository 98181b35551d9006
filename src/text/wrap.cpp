#include "text/wrap.h"

#include <sstream>

namespace vdbeam {

std::string two_columns(const std::string& name, const std::string& description, std::size_t indent,
                        std::size_t width) {
  std::string text = "  " + name;
  std::size_t column = indent;
  const auto new_line = [&] {
    text += '\n';
    text.append(indent, ' ');
    column = indent;
  };
  if (text.size() + 2 > indent && !name.empty())
    new_line();
  else
    text.resize(indent, ' ');
  std::istringstream words(description);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > width)
      new_line();
    if (column > indent) {
      text += ' ';
      ++column;
    }
    text += word;
    column += word.size();
  }
  return text + "\n";
}

} // namespace vdbeam
