#pragma once

#include "vdbeam/render.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vdbeam {

/// Content of a report beside the result of the render.
struct ReportContext {
  std::string scene_hash;
  std::string output;           ///< path of the image
  std::string reference;        ///< path of the reference, or empty
  std::string second_reference; ///< path; empty: none
  std::uint64_t deep_bytes = 0; ///< size of the deep picture's file
};

/// Every key of the scene, as nested objects named like in a scene file.
nlohmann::ordered_json settings_json(const Scene& scene);

/// Seconds of a render by stage, up to the last pass.
nlohmann::ordered_json stage_seconds_json(const RenderStatistics& statistics);

/// The plan, as in reports and `vdbeam plan --json`.
nlohmann::ordered_json plan_json(const RenderPlan& plan);

/// The passes of a plan at which something changes, as in plan_json().
nlohmann::ordered_json schedule_json(const RenderPlan& plan);

/// The report of a frame (docs/reference/output.md). Numbers that are not finite become null.
nlohmann::ordered_json report_json(const Scene& scene, const RenderResult& result,
                                   const ReportContext& context);

/// Two spaces deep, with a line break at its end.
std::string json_text(const nlohmann::ordered_json& json);

/// Writes JSON so that the file is never half there. Throws FrameError.
void write_json(const nlohmann::ordered_json& json, const std::string& path);

} // namespace vdbeam
