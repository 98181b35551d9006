#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vdbeam {

/// Bytes of the UTF-8 sequence that begins at `text[at]`; 0 where there is no valid one.
std::size_t utf8_length(std::string_view text, std::size_t at);

/// The text as UTF-8: unchanged where it is valid, else its bytes are taken for Latin-1.
std::string as_utf8(const std::string& text);

/// The text without control characters, which could move the cursor of a terminal, change colours
/// or hide other text: each is shown by its number ("\x1b", "\u009b"), white space as a space.
std::string printable_line(std::string_view text);

/// The same for text of several lines: line breaks and tabs stay.
std::string printable_text(std::string_view text);

} // namespace vdbeam
