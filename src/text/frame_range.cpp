#include "text/frame_range.h"

#include "vdbeam/error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <system_error>

namespace vdbeam {
namespace {

constexpr std::size_t frame_limit = 1'000'000;

/// Takes a decimal number, with an optional minus sign, off the front of `rest`.
std::optional<int> take_number(std::string_view& rest) {
  int value = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc{})
    return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return value;
}

bool take(std::string_view& rest, std::string_view characters) {
  if (rest.empty() || characters.find(rest.front()) == std::string_view::npos)
    return false;
  rest.remove_prefix(1);
  return true;
}

struct Range {
  std::int64_t first, last, step;
};

std::optional<Range> parse_part(std::string_view rest) {
  const auto first = take_number(rest);
  if (!first)
    return std::nullopt;
  Range range{*first, *first, 1};
  if (take(rest, "-")) {
    const auto last = take_number(rest);
    if (!last)
      return std::nullopt;
    range.last = *last;
    if (take(rest, "x:")) {
      const auto step = take_number(rest);
      if (!step || *step < 1)
        return std::nullopt;
      range.step = *step;
    }
  }
  return rest.empty() ? std::optional(range) : std::nullopt;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ')
    text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ')
    text.remove_suffix(1);
  return text;
}

/// One place for a frame number in a path.
struct Pattern {
  std::size_t begin = 0, length = 0;
  int digits = 0;
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The number written at `position`, at most two digits long, or nothing; moves past it.
int take_width(const std::string& path, std::size_t& position) {
  int width = 0;
  for (int i = 0; i < 2 && position < path.size() && is_digit(path[position]); ++i)
    width = 10 * width + (path[position++] - '0');
  return width;
}

/// `${F4}` or `<F4>` at `begin`.
std::optional<Pattern> find_bracketed(const std::string& path, std::size_t begin) {
  const std::string_view rest = std::string_view(path).substr(begin);
  const bool braces = rest.starts_with("${F");
  if (!braces && !rest.starts_with("<F") && !rest.starts_with("<f"))
    return std::nullopt;
  std::size_t end = begin + (braces ? 3 : 2);
  const int width = take_width(path, end);
  if (end >= path.size() || path[end] != (braces ? '}' : '>'))
    return std::nullopt;
  return Pattern{begin, end + 1 - begin, width};
}

std::optional<Pattern> find_pattern(const std::string& path, std::size_t start) {
  for (std::size_t i = start; i < path.size(); ++i) {
    std::size_t end = i + 1;
    if (path[i] == '#' || path[i] == '@') {
      while (end < path.size() && path[end] == path[i])
        ++end;
      const int count = static_cast<int>(end - i);
      if (path[i] == '#' || count > 1) // a single @ is a letter like others
        return Pattern{i, end - i, count == 1 ? 4 : count};
    }
    if (path[i] == '%') {
      const int width = take_width(path, end);
      if (end < path.size() && path[end] == 'd')
        return Pattern{i, end + 1 - i, width};
    }
    if (path[i] == '$' && end < path.size() && path[end] == 'F') {
      ++end;
      const int width = take_width(path, end);
      return Pattern{i, end - i, width};
    }
    if (const auto pattern = find_bracketed(path, i))
      return pattern;
  }
  return std::nullopt;
}

} // namespace

std::vector<int> parse_frame_range(const std::string& text) {
  std::vector<int> frames;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const auto range = parse_part(trim(rest.substr(0, comma)));
    if (!range)
      throw InputError(
          fmt::format("frames must look like 7, 1-24, 1-100x2 or 1,5,9-12, got \"{}\"", text));
    const auto [low, high] = std::minmax(range->first, range->last);
    if (static_cast<std::size_t>((high - low) / range->step) + frames.size() >= frame_limit)
      throw InputError(fmt::format("frames must be at most {}, got \"{}\"", frame_limit, text));
    const std::int64_t sign = range->first <= range->last ? 1 : -1;
    for (std::int64_t offset = 0; offset <= high - low; offset += range->step)
      frames.push_back(static_cast<int>(range->first + sign * offset));
    if (comma == std::string_view::npos)
      break;
    rest.remove_prefix(comma + 1);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::string format_frame_range(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1)
      ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", frames[i]);
    if (end - i > 1)
      text += fmt::format("{}{}", end - i == 2 ? "," : "-", frames[end - 1]);
    i = end;
  }
  return text;
}

bool has_frame_pattern(const std::string& path) {
  return find_pattern(path, 0).has_value();
}

std::string substitute_frame(const std::string& path, int frame) {
  std::string result;
  std::size_t position = 0;
  while (const auto pattern = find_pattern(path, position)) {
    result += path.substr(position, pattern->begin - position);
    result += fmt::format("{:0{}d}", frame, pattern->digits);
    position = pattern->begin + pattern->length;
  }
  return result + path.substr(position);
}

std::string foreign_token(const std::string& path) {
  const std::string name = substitute_frame(std::filesystem::path(path).filename().string(), 0);
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == '*' || name[i] == '?')
      return name.substr(i, 1);
    if (name[i] == '%' && i + 1 < name.size() && (name[i + 1] == 'V' || name[i + 1] == 'v'))
      return name.substr(i, 2);
    if (name[i] == '<')
      if (const std::size_t end = name.find('>', i); end != std::string::npos)
        return name.substr(i, end + 1 - i);
  }
  return {};
}

std::string first_token(const std::string& name) {
  if (const auto pattern = find_pattern(name, 0))
    return name.substr(pattern->begin, pattern->length);
  return foreign_token(name);
}

std::string frame_pattern_of(const std::string& path) {
  const std::filesystem::path whole(path);
  std::string name = whole.stem().string();
  const std::size_t last = name.find_last_of("0123456789");
  if (last == std::string::npos)
    return {};
  std::size_t first = last;
  while (first > 0 && is_digit(name[first - 1]))
    --first;
  const std::size_t digits = last + 1 - first;
  // A single # stands for four digits.
  name.replace(first, digits, digits == 1 ? "%d" : std::string(digits, '#'));
  std::filesystem::path pattern = whole;
  return pattern.replace_filename(name + whole.extension().string()).string();
}

std::vector<int> frames_on_disk(const std::string& pattern) {
  namespace fs = std::filesystem;
  const fs::path path(pattern);
  const std::string name = path.filename().string();
  const auto place = find_pattern(name, 0);
  if (!place || has_frame_pattern(path.parent_path().string()))
    return {};
  std::vector<int> frames;
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string candidate = it->path().filename().string();
    if (candidate.size() <= place->begin)
      continue;
    std::string_view rest = std::string_view(candidate).substr(place->begin);
    const auto frame = take_number(rest);
    if (frame && substitute_frame(name, *frame) == candidate)
      frames.push_back(*frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

} // namespace vdbeam
