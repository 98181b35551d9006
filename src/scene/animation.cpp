#include "scene/animation.h"

#include "scene/toml_value.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

constexpr const char* example = "{ keys = [[1, 0.5], [24, 2]], interpolation = \"smooth\" }";

/// One component of a value over the frames.
struct Curve {
  std::vector<double> frames, values;

  double secant(std::size_t i) const {
    return (values[i + 1] - values[i]) / (frames[i + 1] - frames[i]);
  }
  /// Fritsch and Butland, A method for constructing local monotone piecewise cubic interpolants,
  /// SIAM J. Sci. Stat. Comput. 5 (1984): the weighted harmonic mean of the secants; 0 at the ends
  /// and where the curve turns.
  double slope(std::size_t i) const {
    if (i == 0 || i + 1 == frames.size())
      return 0;
    const double left = secant(i - 1), right = secant(i);
    if (left * right <= 0)
      return 0;
    const double before = frames[i] - frames[i - 1], after = frames[i + 1] - frames[i];
    const double weight = (before + 2 * after) / (3 * (before + after));
    return left * right / (weight * right + (1 - weight) * left);
  }
  double at(double frame, bool smooth) const {
    if (frame <= frames.front())
      return values.front();
    if (frame >= frames.back())
      return values.back();
    const auto next = static_cast<std::size_t>(
        std::upper_bound(frames.begin(), frames.end(), frame) - frames.begin());
    const std::size_t i = next - 1;
    const double width = frames[next] - frames[i], t = (frame - frames[i]) / width;
    if (!smooth)
      return values[i] + t * (values[next] - values[i]);
    const double s = 1 - t;
    const double value = s * s * (1 + 2 * t) * values[i] + t * t * (3 - 2 * t) * values[next] +
                         width * t * s * (s * slope(i) - t * slope(next));
    const auto [low, high] = std::minmax(values[i], values[next]);
    return std::clamp(value, low, high); // rounding must not leave a key's range
  }
};

std::vector<double> components(const KeyValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value))
    return {static_cast<double>(*whole)};
  if (const auto* number = std::get_if<double>(&value))
    return {*number};
  if (const auto* list = std::get_if<std::vector<double>>(&value))
    return *list;
  return {};
}

/// Reads the table and evaluates its curves.
class Animation {
public:
  Animation(const SceneKey& key, const std::string& path, const toml::table& table)
      : key_(key), path_(path), table_(table) {}

  KeyValue at(double time) {
    read_interpolation();
    read_keys();
    std::vector<double> values;
    for (const Curve& curve : curves_)
      values.push_back(curve.at(time, smooth_));
    if (key_.kind == KeyKind::integer)
      return static_cast<std::int64_t>(std::llround(values[0]));
    if (values.size() == 1)
      return values[0];
    return values;
  }

private:
  [[noreturn]] void fail(const toml::node& node, const std::string& text) const {
    throw InputError(one_line(fmt::format("{}: {} {}", location_of(node), path_, text)));
  }

  void read_interpolation() {
    for (const auto& [name, node] : table_)
      if (name != "keys" && name != "interpolation")
        fail(node, fmt::format("has an unknown entry {}; animated it looks like {}",
                               std::string(name.str()), example));
    const toml::node* node = table_.get("interpolation");
    if (!node)
      return;
    const auto text = node->value<std::string>().value_or("");
    if (text != "linear" && text != "smooth")
      fail(*node, "interpolation must be linear or smooth, got " + node_text(*node));
    smooth_ = text == "smooth";
  }

  void read_keys() {
    const toml::node* node = table_.get("keys");
    const toml::array* keys = node ? node->as_array() : nullptr;
    if (!keys || keys->empty())
      fail(table_, fmt::format("needs a list of keys to be animated: {}", example));
    for (const toml::node& entry : *keys)
      read_pair(entry);
  }

  void read_pair(const toml::node& entry) {
    const toml::array* pair = entry.as_array();
    const auto frame = pair && pair->size() == 2 && (*pair)[0].is_number()
                           ? (*pair)[0].value<double>()
                           : std::nullopt;
    if (!frame || !std::isfinite(*frame))
      fail(entry, fmt::format("must have keys of [frame, value], got {}", node_text(entry)));
    const auto values = components(read_key_value(key_, path_, (*pair)[1]));
    if (values.empty())
      fail(entry, fmt::format("can only be animated between numbers, got {}", node_text(entry)));
    curves_.resize(values.size());
    if (!curves_[0].frames.empty() && *frame <= curves_[0].frames.back())
      fail(entry, "must have its keys in the order of their frames");
    for (std::size_t i = 0; i < values.size(); ++i) {
      curves_[i].frames.push_back(*frame);
      curves_[i].values.push_back(values[i]);
    }
  }

  const SceneKey& key_;
  const std::string& path_;
  const toml::table& table_;
  std::vector<Curve> curves_;
  bool smooth_ = false;
};

bool is_numeric(KeyKind kind) {
  return kind != KeyKind::boolean && kind != KeyKind::text && kind != KeyKind::file &&
         kind != KeyKind::choice;
}

} // namespace

KeyValue read_value_at(const SceneKey& key, const std::string& path, const toml::node& node,
                       double time) {
  const toml::table* table = node.as_table();
  if (!table || !is_numeric(key.kind))
    return read_key_value(key, path, node);
  return Animation(key, path, *table).at(time);
}

} // namespace vdbeam
