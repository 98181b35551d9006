#include "cli/batch_values.h"

#include "film/film_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

namespace vdbeam::cli {
namespace {

[[noreturn]] void reject(const std::string& option, const std::string& text,
                         const std::string& right) {
  throw InputError(one_line(fmt::format("{} {}: must {}", option, text, right)));
}

/// Whole numbers that a separator divides, none below `least`; nothing for any other text.
std::optional<std::vector<int>> parse_numbers(const std::string& text, char separator,
                                              int least = 0) {
  std::vector<int> numbers;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    int number = 0;
    const char* const end = part.data() + part.size();
    const auto [stop, error] = std::from_chars(part.data(), end, number);
    if (error != std::errc{} || stop != end || part.empty() || number < least)
      return std::nullopt;
    numbers.push_back(number);
  }
  if (!text.empty() && text.back() == separator)
    return std::nullopt;
  return numbers;
}

/// Seconds and passes; one is above 0, the other is 0.
std::pair<double, int> parse_interval(const std::string& option, const std::string& text,
                                      const std::string& examples) {
  const auto passes = parse_numbers(text, ' ');
  if (passes && passes->size() == 1 && passes->front() > 0)
    return {0, passes->front()};
  const double seconds = passes ? 0 : parse_duration(text).value_or(0);
  if (!(seconds > 0))
    reject(
        option, text,
        fmt::format("be a time like {}, or a number of passes{}", examples, duration_remedy(text)));
  return {seconds, 0};
}

} // namespace

PassRange parse_pass_range(const std::string& text) {
  const auto numbers = parse_numbers(text, '-');
  if (!numbers || numbers->empty() || numbers->size() > 2 || numbers->back() < numbers->front() ||
      numbers->back() >= most_passes)
    reject("--pass-range", text,
           fmt::format("look like 0-63: passes from 0, both ends included, below {}", most_passes));
  return {numbers->front(), numbers->back()};
}

PixelRegion parse_region(const std::string& text) {
  const auto numbers = parse_numbers(text, ',', -16384);
  if (!numbers || numbers->size() != 4 || (*numbers)[2] <= (*numbers)[0] ||
      (*numbers)[3] <= (*numbers)[1])
    reject("--region", text, "look like x0,y0,x1,y1 with x0 < x1 and y0 < y1, in pixels");
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
}

CheckpointSettings parse_checkpoint(const std::string& text) {
  CheckpointSettings settings;
  std::tie(settings.seconds, settings.passes) = parse_interval("--checkpoint", text, "300s or 5m");
  return settings;
}

SnapshotInterval parse_snapshot(const std::string& text) {
  SnapshotInterval interval;
  std::tie(interval.seconds, interval.passes) = parse_interval("--snapshot", text, "2s or 1m");
  return interval;
}

} // namespace vdbeam::cli
