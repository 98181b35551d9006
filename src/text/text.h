#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// The candidate nearest to `written` by edit distance (insert, delete, replace, swap neighbours),
/// capitals ignored, or nothing where none is near enough to be what was meant.
std::optional<std::string> nearest_word(const std::string& written,
                                        const std::vector<std::string>& candidates);

/// At most `most` bytes of the text: "..." stands for what is cut out of its middle.
std::string shortened(const std::string& text, std::size_t most);

/// The text on one line, as messages need it: without control characters, long words (the paths
/// that a message begins with) cut in their middle, so that the reason at its end is not lost.
std::string one_line(const std::string& text);

/// With small letters for the capitals of ASCII.
std::string lower_case(std::string text);

/// "a, b and c" (or the last joined by `conjunction`).
std::string join_words(const std::vector<std::string>& words, const std::string& conjunction);

/// "1 pass", "12 passes".
std::string count_text(std::uint64_t count, const std::string& noun);

/// Seconds of "90", "60s", "5m", "1h" or "1h30m"; nothing where the text is no duration.
std::optional<double> parse_duration(const std::string& text);

/// "[0, 0, 5]" for a list of numbers without brackets, like "0,0,5" or "0 0 5"; empty for any other
/// text.
std::string bracketed_numbers(const std::string& text);

/// "; did you mean 5m?" for a text like "5min" that means a duration; empty for any other.
std::string duration_remedy(const std::string& text);

/// "1h02m", "3m20s", "12.3s": how long something takes, for people.
std::string format_duration(double seconds);

/// "1.5 GiB", "320 MiB", "7 KiB".
std::string format_bytes(double bytes);

} // namespace vdbeam
