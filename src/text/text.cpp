#include "text/text.h"

#include "text/printable.h"

#include <algorithm>
#include <array>
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

std::optional<std::string> nearest_word(const std::string& written,
                                        const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 64; // no key is longer, and the table above is quadratic
  if (written.size() > longest)
    return std::nullopt;
  const std::string word = lower_case(written);
  std::optional<std::string> best;
  std::size_t best_distance = 0;
  for (const std::string& name : candidates) {
    const std::string candidate = lower_case(name);
    const bool extends =
        word.size() >= 3 && (candidate.starts_with(word) || word.starts_with(candidate));
    // An ending that is missing is nearer than two wrong letters, and farther than one.
    const std::size_t edits = 2 * edit_distance(word, candidate);
    const std::size_t distance = extends ? std::min<std::size_t>(edits, 3) : edits;
    const std::size_t allowed =
        2 * std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3);
    if ((extends || distance <= allowed) && (!best || distance < best_distance)) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most)
    return text;
  const auto inside_character = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80;
  };
  std::size_t head = most / 3, tail = text.size() - (most - 3 - head);
  while (head > 0 && inside_character(head))
    --head;
  while (tail < text.size() && inside_character(tail))
    ++tail;
  return text.substr(0, head) + "..." + text.substr(tail);
}

std::string one_line(const std::string& text) {
  constexpr std::size_t longest_word = 300, longest = 1500;
  std::string line;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    line += printable_line(shortened(text.substr(begin, end - begin), longest_word));
    if (end < text.size())
      line += ' ';
    begin = end + 1;
  }
  return shortened(line, longest);
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

std::string bracketed_numbers(const std::string& text) {
  constexpr std::size_t longest = 400; // of 12 numbers
  std::string list;
  int count = 0;
  for (std::size_t at = 0; at < text.size() && text.size() <= longest;) {
    if (text[at] == ' ' || text[at] == ',') {
      ++at;
      continue;
    }
    const std::size_t end = std::min(text.find_first_of(" ,", at), text.size());
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + end, number);
    if (error != std::errc{} || stop != text.data() + end)
      return {};
    list += (count++ > 0 ? ", " : "") + text.substr(at, end - at);
    at = end;
  }
  return count > 1 ? "[" + list + "]" : "";
}

std::string duration_remedy(const std::string& text) {
  std::string plain;
  for (const char c : lower_case(text))
    if (c != ' ')
      plain += c;
  std::string result;
  for (std::size_t at = 0; at < plain.size();) {
    const std::size_t end = std::min(plain.find_first_of("0123456789.", at), plain.size());
    if (end == at) {
      result += plain[at++];
      continue;
    }
    const std::string unit = plain.substr(at, end - at);
    constexpr std::array units{std::pair("seconds", 's'), std::pair("minutes", 'm'),
                               std::pair("mins", 'm'), std::pair("hours", 'h'),
                               std::pair("hrs", 'h')};
    const auto found = std::find_if(units.begin(), units.end(), [&](const auto& known) {
      return std::string_view(known.first).starts_with(unit);
    });
    if (found == units.end())
      return {};
    result += found->second;
    at = end;
  }
  return parse_duration(result) ? "; did you mean " + result + "?" : "";
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
