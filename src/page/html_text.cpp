#include "page/html_text.h"

#include "text/printable.h"

#include <fmt/format.h>

namespace vdbeam {

std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : printable_line(as_utf8(std::string(text)))) {
    switch (c) {
    case '&':
      result += "&amp;";
      break;
    case '<':
      result += "&lt;";
      break;
    case '>':
      result += "&gt;";
      break;
    case '"':
      result += "&quot;";
      break;
    case '\'':
      result += "&#39;";
      break;
    default:
      result += c;
    }
  }
  return result;
}

std::string number_text(double value) {
  return fmt::format("{:.3g}", value);
}

} // namespace vdbeam
