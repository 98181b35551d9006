#include "text/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Optimal string alignment distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j)
    d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 64; // no key is longer, and the table above is quadratic
  if (word.size() > longest)
    return std::nullopt;
  std::optional<std::string> best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    const bool extends =
        word.size() >= 3 && (candidate.starts_with(word) || word.starts_with(candidate));
    // An ending that is missing is nearer than two wrong letters, and farther than one.
    const std::size_t edits = 2 * edit_distance(word, candidate);
    const std::size_t distance = extends ? std::min<std::size_t>(edits, 3) : edits;
    const std::size_t allowed =
        2 * std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3);
    if ((extends || distance <= allowed) && (!best || distance < best_distance)) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string one_line(const std::string& text) {
  constexpr std::size_t longest = 200;
  std::string result = text.size() > longest ? text.substr(0, longest) + "..." : text;
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      c = ' ';
  return result;
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string join_words(const std::vector<std::string>& words, const std::string& conjunction) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0)
      text += i + 1 == words.size() ? " " + conjunction + " " : ", ";
    text += words[i];
  }
  return text;
}

std::string count_text(std::uint64_t count, const std::string& noun) {
  const std::string ending = count == 1 ? "" : noun.ends_with('s') ? "es" : "s";
  return fmt::format("{} {}{}", count, noun, ending);
}

std::optional<double> parse_duration(const std::string& text) {
  const char* p = text.data();
  const char* const end = p + text.size();
  double total = 0, last_unit = 1e9;
  if (p == end)
    return std::nullopt;
  while (p != end) {
    double value = 0;
    const auto [next, error] = std::from_chars(p, end, value, std::chars_format::fixed);
    if (error != std::errc{} || !std::isfinite(value) || value < 0)
      return std::nullopt;
    p = next;
    double unit = 1;
    if (p != end) {
      unit = *p == 's' ? 1 : *p == 'm' ? 60 : *p == 'h' ? 3600 : 0;
      ++p;
    }
    if (unit == 0 || unit >= last_unit)
      return std::nullopt;
    last_unit = unit;
    total += value * unit;
  }
  return total;
}

std::string format_duration(double seconds) {
  if (seconds < 59.95)
    return fmt::format("{:.1f}s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600)
    return fmt::format("{}m{:02}s", whole / 60, whole % 60);
  return fmt::format("{}h{:02}m", whole / 3600, whole / 60 % 60);
}

std::string format_bytes(double bytes) {
  if (bytes >= 1024. * 1024 * 1024)
    return fmt::format("{:.1f} GiB", bytes / (1024. * 1024 * 1024));
  if (bytes >= 1024. * 1024)
    return fmt::format("{:.0f} MiB", bytes / (1024. * 1024));
  return fmt::format("{:.0f} KiB", std::ceil(bytes / 1024));
}

} // namespace vdbeam
