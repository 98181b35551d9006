#include "batch/frame_events.h"

#include "console/events.h"
#include "console/progress.h"
#include "report/report.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>

namespace vdbeam::cli {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

const char* name_of(RenderStep step) {
  switch (step) {
  case RenderStep::prepare:
    return "prepare";
  case RenderStep::pilot:
    return "pilot";
  case RenderStep::photons:
    return "photons";
  case RenderStep::pass:
    return "pass";
  case RenderStep::develop:
    return "write"; // writing follows at once
  }
  return "";
}

const char* name_of(Output kind) {
  switch (kind) {
  case Output::image:
    return "image";
  case Output::deep:
    return "deep";
  case Output::checkpoint:
    return "checkpoint";
  case Output::snapshot:
    return "snapshot";
  case Output::preview:
    return "preview";
  case Output::report:
    return "report";
  case Output::summary:
    return "summary";
  case Output::page:
    return "page";
  case Output::thumbnail:
    return "thumbnail";
  }
  return "";
}

/// Names of the image's layers as scene files have them, in the order of the channels: "rgba" and
/// what stands before the last dot of other channels.
Json layers_of(const Image& image) {
  Json layers = Json::array();
  for (const auto& channel : image.channels) {
    const std::size_t dot = channel.name.rfind('.');
    const std::string layer = dot == std::string::npos ? "rgba" : channel.name.substr(0, dot);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end())
      layers.push_back(layer);
  }
  return layers;
}

} // namespace

void send_frame(const Scene& scene, const RenderSettings& limits, const std::string& output,
                std::size_t index) {
  const ImageSettings& image = scene.image;
  send_event("frame", {{"frame", scene.frame.number},
                       {"index", index},
                       {"output", output},
                       {"width", image.width},
                       {"height", image.height},
                       {"overscan", image.overscan},
                       {"estimator", scene.render.estimator.name},
                       {"passes", or_null(limits.passes)},
                       {"seconds", or_null(limits.time)},
                       {"target_error", or_null(limits.target_error)}});
}

void send_reading(int frame) {
  send_event("stage", {{"frame", frame}, {"stage", "read"}});
}

void send_step(int frame, RenderStep step, int pass) {
  Json fields{{"frame", frame}, {"stage", name_of(step)}};
  if (pass > 0)
    fields["pass"] = pass;
  send_event("stage", fields);
}

void send_pass(int frame, const PassRecord& record, const RenderStatistics& statistics,
               const RenderSettings& limits) {
  if (!events_enabled())
    return;
  const double done = Progress::fraction(record, limits);
  send_event("pass",
             {{"frame", frame},
              {"pass", record.pass},
              {"passes", or_null(limits.passes)},
              {"seconds", record.seconds},
              {"done", done},
              {"seconds_left", done > 0 ? Json(record.seconds * (1 - done) / done) : Json()},
              {"error", record.error_estimate},
              {"error_low", record.error_low},
              {"error_high", record.error_high},
              {"photons", record.photons},
              {"peak_memory", statistics.peak_memory},
              {"seconds_by_stage", stage_seconds_json(statistics)}});
}

void send_frame_error(int frame, const Failure& failure) {
  send_event("message", {{"level", "error"},
                         {"frame", frame},
                         {"text", failure.line},
                         {"exit_code", static_cast<int>(failure.code)}});
}

void send_note(int frame, const std::string& text) {
  send_event("message", {{"level", "note"}, {"frame", frame}, {"text", text}});
}

void send_file(Output kind, const std::string& path, int frame, const RenderResult& result) {
  if (!events_enabled() || path.empty() || path == "-")
    return;
  std::error_code error; // of a current folder that is gone: the path stays as given
  const auto absolute = std::filesystem::absolute(path, error);
  Json fields{{"frame", frame},
              {"kind", name_of(kind)},
              {"path", error ? path : absolute.string()},
              {"pass", result.passes.empty() ? 0 : result.passes.back().pass}};
  if (kind == Output::image || kind == Output::snapshot) {
    fields["layers"] = layers_of(result.image);
    fields["draft"] = result.draft > 0 || result.quick_look;
  }
  send_event("file", fields);
}

void send_frame_end(const FrameOutcome& outcome) {
  send_event("frame_end", {{"frame", outcome.frame},
                           {"status", outcome.status},
                           {"output", outcome.output},
                           {"seconds", outcome.seconds},
                           {"reason", outcome.reason}});
}

} // namespace vdbeam::cli
