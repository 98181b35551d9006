#include "scene/volume_time.h"

#include "scene/animation.h"
#include "scene/toml_value.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

using OutOfRange = VolumeTime::OutOfRange;

constexpr std::array<std::pair<const char*, OutOfRange>, 4> policies{
    {{"clip", OutOfRange::clip},
     {"hold", OutOfRange::hold},
     {"repeat", OutOfRange::repeat},
     {"ping-pong", OutOfRange::ping_pong}}};

/// x modulo period, in [0, period).
std::int64_t wrap(std::int64_t x, std::int64_t period) {
  return ((x % period) + period) % period;
}

OutOfRange read_policy(const toml::node& node, const std::string& path) {
  std::vector<std::string> names;
  for (const auto& [name, policy] : policies) {
    names.emplace_back(name);
    if (node.value<std::string>() == name)
      return policy;
  }
  throw InputError(one_line(fmt::format("{}: {}.out_of_range must be {}, got {}", location_of(node),
                                        path, join_words(names, "or"), node_text(node))));
}

double read_number(const char* name, const toml::node& node, const std::string& path, int frame) {
  SceneKey key;
  key.section = SceneSection::volume;
  key.name = name;
  key.kind = KeyKind::number;
  key.range = {.lower = -1e6, .upper = 1e6};
  return std::get<double>(read_value_at(key, path + "." + name, node, frame));
}

} // namespace

std::optional<int> VolumeTime::file_frame(int frame, const std::vector<int>& on_disk) const {
  const auto number = static_cast<std::int64_t>(std::llround(offset + speed * frame));
  if (on_disk.empty())
    return static_cast<int>(number);
  const std::int64_t first = on_disk.front(), last = on_disk.back(), count = last - first + 1;
  if (number >= first && number <= last)
    return static_cast<int>(number);
  switch (out_of_range) {
  case OutOfRange::clip:
    return std::nullopt;
  case OutOfRange::hold:
    return static_cast<int>(std::clamp(number, first, last));
  case OutOfRange::repeat:
    return static_cast<int>(first + wrap(number - first, count));
  case OutOfRange::ping_pong: {
    const std::int64_t period = std::max<std::int64_t>(1, 2 * (count - 1));
    const std::int64_t place = wrap(number - first, period);
    return static_cast<int>(first + std::min(place, period - place));
  }
  }
  return std::nullopt;
}

VolumeTime read_volume_time(const toml::node& node, const std::string& path, int frame) {
  const toml::table* table = node.as_table();
  if (!table)
    throw InputError(fmt::format("{}: {} must be a table, e.g. {{ offset = 10, speed = 0.5, "
                                 "out_of_range = \"repeat\" }}, got {}",
                                 location_of(node), path, node_text(node)));
  VolumeTime time;
  for (const auto& [key, value] : *table) {
    const std::string name(key.str());
    if (name == "offset")
      time.offset = read_number("offset", value, path, frame);
    else if (name == "speed")
      time.speed = read_number("speed", value, path, frame);
    else if (name == "out_of_range")
      time.out_of_range = read_policy(value, path);
    else
      throw InputError(
          one_line(fmt::format("{}: unknown key {}.{}; its keys are offset, speed and out_of_range",
                               location_of(value), path, name)));
  }
  return time;
}

} // namespace vdbeam
