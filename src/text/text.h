#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// The candidate nearest to `word` by edit distance (insert, delete, replace, swap neighbours), or
/// nothing where none is near enough to be what was meant.
std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& candidates);

/// The text on one line, as messages need it: control characters become spaces, and what exceeds
/// 160 bytes is cut off and marked by "...".
std::string one_line(const std::string& text);

/// With small letters for the capitals of ASCII.
std::string lower_case(std::string text);

/// "a, b and c" (or the last joined by `conjunction`).
std::string join_words(const std::vector<std::string>& words, const std::string& conjunction);

/// "1 pass", "12 passes".
std::string count_text(std::uint64_t count, const std::string& noun);

/// Seconds of "90", "60s", "5m", "1h" or "1h30m"; nothing where the text is no duration.
std::optional<double> parse_duration(const std::string& text);

/// "1h02m", "3m20s", "12.3s": how long something takes, for people.
std::string format_duration(double seconds);

/// "1.5 GiB", "320 MiB", "7 KiB".
std::string format_bytes(double bytes);

} // namespace vdbeam
