#include "text/printable.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

bool is_space(unsigned c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// C0 and C1 control characters and "delete".
bool is_control(unsigned c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0);
}

std::string printable(std::string_view text, bool keeps_breaks) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const unsigned c = byte_at(text, at);
    if (length <= 1 && is_space(c))
      result += keeps_breaks && (c == '\n' || c == '\t') ? text[at] : ' ';
    else if (length <= 1 && is_control(c))
      result += fmt::format("\\x{:02x}", c);
    else if (length == 2 && c == 0xc2 && is_control(byte_at(text, at + 1)))
      result += fmt::format("\\u{:04x}", byte_at(text, at + 1));
    else
      result += text.substr(at, length > 0 ? length : 1);
    at += length > 0 ? length : 1;
  }
  return result;
}

} // namespace

std::size_t utf8_length(std::string_view text, std::size_t at) {
  const unsigned first = byte_at(text, at);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0 // a continuation, or a longer way to write ASCII
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length == 0 || at + length > text.size())
    return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte_at(text, at + i) & 0xc0) != 0x80)
      return 0;
  if (length < 3)
    return length;
  // Longer than need be, half of a UTF-16 pair, or beyond the last code point.
  const unsigned second = byte_at(text, at + 1);
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return wrong ? 0 : length;
}

std::string as_utf8(const std::string& text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0)
      break;
    at += length;
  }
  if (at == text.size())
    return text;
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      result += c;
    } else {
      result += static_cast<char>(0xc0 | (byte >> 6));
      result += static_cast<char>(0x80 | (byte & 0x3f));
    }
  }
  return result;
}

std::string printable_line(std::string_view text) {
  return printable(text, false);
}

std::string printable_text(std::string_view text) {
  return printable(text, true);
}

} // namespace vdbeam
