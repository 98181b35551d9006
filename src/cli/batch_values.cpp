#include "cli/batch_values.h"

#include "film/film_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <sstream>
#include <vector>

namespace vdbeam::cli {
namespace {

[[noreturn]] void fail(const std::string& option, const std::string& text,
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

} // namespace

PassRange parse_pass_range(const std::string& text) {
  const auto numbers = parse_numbers(text, '-');
  if (!numbers || numbers->empty() || numbers->size() > 2 || numbers->back() < numbers->front() ||
      numbers->back() >= most_passes)
    fail("--pass-range", text,
         fmt::format("look like 0-63: passes from 0, both ends included, below {}", most_passes));
  return {numbers->front(), numbers->back()};
}

PixelRegion parse_region(const std::string& text) {
  const auto numbers = parse_numbers(text, ',', -16384);
  if (!numbers || numbers->size() != 4 || (*numbers)[2] <= (*numbers)[0] ||
      (*numbers)[3] <= (*numbers)[1])
    fail("--region", text, "look like x0,y0,x1,y1 with x0 < x1 and y0 < y1, in pixels");
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
}

CheckpointSettings parse_checkpoint(const std::string& text) {
  CheckpointSettings settings;
  if (const auto passes = parse_numbers(text, ' '); passes && passes->size() == 1)
    settings.passes = passes->front();
  else
    settings.seconds = parse_duration(text).value_or(0);
  if (settings.passes == 0 && !(settings.seconds > 0))
    fail("--checkpoint", text,
         "be a time like 300s or 5m, or a number of passes" + duration_remedy(text));
  return settings;
}

} // namespace vdbeam::cli
