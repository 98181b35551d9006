#include "batch/batch_summary.h"
#include "machine/input_file.h"
#include "text/printable.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 28; // of about a million frames

/// Reads values of one object of the file, `place` in messages ("frames.3.").
class Entries {
public:
  Entries(const std::string& path, std::string place, const Json& object)
      : path_(path), place_(std::move(place)), object_(object) {
    if (!object.is_object())
      fail("", "must be an object");
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(
        one_line(fmt::format("{}: {}{}{}{}; give a file that vdbeam render --summary wrote", path_,
                             place_, key, place_.empty() && key.empty() ? "" : " ", what)));
  }
  const Json* find(const std::string& key) const {
    const auto found = object_.find(key);
    return found == object_.end() || found->is_null() ? nullptr : &*found;
  }
  const Json& need(const std::string& key) const {
    const Json* value = find(key);
    if (!value)
      fail(key, "is missing");
    return *value;
  }
  std::string text(const std::string& key, const Json& value) const {
    if (!value.is_string())
      fail(key, fmt::format("must be a text, got {}", value.dump()));
    return value.get<std::string>();
  }
  std::string text(const std::string& key) const {
    const Json* value = find(key);
    return value ? text(key, *value) : "";
  }
  int whole(const std::string& key, const Json& value) const {
    const bool fits = value.is_number_integer() && value >= std::numeric_limits<int>::min() &&
                      value <= std::numeric_limits<int>::max();
    if (!fits)
      fail(key, fmt::format("must be a whole number, got {}", value.dump()));
    return value.get<int>();
  }
  std::optional<double> number(const std::string& key) const {
    const Json* value = find(key);
    if (value && !value->is_number())
      fail(key, fmt::format("must be a number, got {}", value->dump()));
    return value ? std::optional(value->get<double>()) : std::nullopt;
  }

private:
  const std::string& path_;
  std::string place_;
  const Json& object_;
};

FrameOutcome read_outcome(const Entries& entries) {
  FrameOutcome outcome;
  outcome.frame = entries.whole("frame", entries.need("frame"));
  outcome.status = entries.text("status", entries.need("status"));
  const std::vector<std::string> known{"done", "skipped", "failed", "interrupted"};
  if (std::find(known.begin(), known.end(), outcome.status) == known.end())
    entries.fail("status",
                 fmt::format("must be {}, got {}", join_words(known, "or"), outcome.status));
  outcome.output = entries.text("output");
  outcome.reason = entries.text("reason");
  outcome.seconds = entries.number("seconds").value_or(0);
  if (const Json* code = entries.find("exit_code"))
    outcome.exit_code = entries.whole("exit_code", *code);
  outcome.error = entries.number("error");
  outcome.error_low = entries.number("error_low");
  outcome.error_high = entries.number("error_high");
  return outcome;
}

/// Older summaries have none of it.
BatchOrigin read_origin(const std::string& path, const Entries& entries) {
  BatchOrigin origin;
  origin.folder = entries.text("folder");
  origin.command = entries.text("command");
  origin.date = entries.text("date");
  if (const Json* machine = entries.find("machine")) {
    const Entries inner(path, "machine.", *machine);
    origin.cpu = inner.text("cpu");
    if (const Json* cores = inner.find("cores"))
      origin.cores = inner.whole("cores", *cores);
  }
  if (const Json* versions = entries.find("versions")) {
    const Entries inner(path, "versions.", *versions);
    for (const auto& [name, version] : versions->items())
      origin.versions.emplace_back(name, inner.text(name, version));
  }
  return origin;
}

Json parse(const std::string& path) {
  const std::string text = read_text(path, most_bytes);
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw InputError(one_line(fmt::format("{}: is not JSON: {}; give a file that vdbeam render "
                                          "--summary wrote",
                                          path, printable_line(error.what()))));
  }
}

} // namespace

BatchSummary read_summary(const std::string& path) {
  const Json json = parse(path);
  const Entries entries(path, "", json);
  BatchSummary summary;
  summary.scene = entries.text("scene", entries.need("scene"));
  summary.origin = read_origin(path, entries);
  const Json &asked = entries.need("frames_asked"), &frames = entries.need("frames");
  if (!asked.is_array() || !frames.is_array())
    entries.fail(asked.is_array() ? "frames" : "frames_asked", "must be a list");
  for (const Json& frame : asked)
    summary.frames.push_back(entries.whole("frames_asked", frame));
  for (std::size_t i = 0; i < frames.size(); ++i)
    summary.outcomes.push_back(
        read_outcome(Entries(path, fmt::format("frames.{}.", i), frames[i])));
  return summary;
}

std::string image_path(const BatchSummary& summary, const FrameOutcome& outcome) {
  const std::string joined = (fs::path(summary.origin.folder) / outcome.output).string();
  return is_there(joined) ? joined : outcome.output;
}

} // namespace vdbeam::cli
