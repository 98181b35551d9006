#include "batch/batch_summary.h"

#include "batch/output_paths.h"
#include "text/frame_range.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vdbeam::cli {

std::vector<int> BatchSummary::with_status(const std::string& status) const {
  std::vector<int> list;
  for (const FrameOutcome& outcome : outcomes)
    if (outcome.status == status)
      list.push_back(outcome.frame);
  return list;
}

std::string BatchSummary::text() const {
  std::string text = fmt::format("{} frames:", frames.size());
  const char* separator = " ";
  for (const char* status : {"done", "skipped", "failed", "interrupted"})
    if (const auto list = with_status(status); !list.empty()) {
      text += fmt::format("{}{} {} ({})", separator, list.size(), status, format_frame_range(list));
      separator = ", ";
    }
  if (const std::size_t left = frames.size() - outcomes.size(); left > 0)
    text += fmt::format("{}{} not begun", separator, left);
  return text;
}

void BatchSummary::write(const std::string& path) const {
  nlohmann::ordered_json json{{"scene", scene}};
  add_origin(json, origin);
  json["frames_asked"] = frames;
  for (const char* status : {"done", "skipped", "failed", "interrupted"})
    json[status] = with_status(status);
  json["frames"] = nlohmann::ordered_json::array();
  for (const FrameOutcome& outcome : outcomes) {
    nlohmann::ordered_json entry{{"frame", outcome.frame},
                                 {"status", outcome.status},
                                 {"output", outcome.output},
                                 {"seconds", outcome.seconds}};
    if (!outcome.reason.empty())
      entry["reason"] = outcome.reason;
    if (outcome.exit_code)
      entry["exit_code"] = *outcome.exit_code;
    if (outcome.error)
      entry["error"] = *outcome.error;
    if (outcome.error_low && outcome.error_high) {
      entry["error_low"] = *outcome.error_low;
      entry["error_high"] = *outcome.error_high;
    }
    json["frames"].push_back(std::move(entry));
  }
  write_json_output(json, path);
}

} // namespace vdbeam::cli
