#include "cli/commands.h"
#include "cli/scene_options.h"
#include "cli/streams.h"
#include "estimators/estimator_table.h"
#include "report/report.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace vdbeam::cli {
namespace {

struct PlanOptions {
  SceneOptions scene;
  std::optional<int> frame;
  bool json = false;
};

/// The files of meshes and textures; nothing where there are none.
std::string surfaces_text(const RenderPlan& plan) {
  std::string text;
  for (const SurfaceFile& file : plan.surface_files) {
    text += text.empty() ? "\nsurfaces\n" : "";
    text += file.triangles > 0
                ? fmt::format("  {}: {} triangles, {}\n", file.path, file.triangles,
                              format_bytes(static_cast<double>(file.bytes)))
                : fmt::format("  {}: {} x {} pixels, {}\n", file.path, file.width, file.height,
                              format_bytes(static_cast<double>(file.bytes)));
  }
  return text;
}

std::string plan_text(const Scene& scene, const RenderPlan& plan) {
  std::string text = fmt::format("{}\n\nestimator\n  {:<18} {}\n", scene.path, plan.estimator,
                                 estimator_kind(scene.render.estimator).help);
  for (const bool needed : {true, false}) {
    text += fmt::format("\n{}\n", needed ? "stages" : "left out");
    for (const PlanStage& stage : plan.stages)
      if (stage.needed == needed)
        text += fmt::format("  {:<18} {}\n", stage_name(stage.stage), stage.reason);
  }
  const auto bytes = [](std::uint64_t n) { return format_bytes(static_cast<double>(n)); };
  text += fmt::format("\nmemory, about\n  {:<18} {}\n  {:<18} {}\n  {:<18} {}\n", "volumes",
                      bytes(plan.volume_bytes), "photons", bytes(plan.photon_bytes), "film",
                      bytes(plan.film_bytes));
  for (const auto& [name, size] : {std::pair{"surfaces", plan.surface_bytes},
                                   {"moments", plan.moment_bytes},
                                   {"deep", plan.deep_bytes}})
    if (size > 0)
      text += fmt::format("  {:<18} {}\n", name, bytes(size));
  return text + surfaces_text(plan);
}

int run_plan(const PlanOptions& options) {
  const SceneDocument document = options.scene.open();
  int frame = options.frame.value_or(1);
  if (!options.frame && document.has_frame_pattern())
    if (const auto frames = document.frames_on_disk(); !frames.empty())
      frame = frames.front();
  const Scene scene = document.scene_at(frame);
  for (const std::string& note : scene.notes)
    log("note: {}", note);
  const RenderPlan plan = make_plan(scene);
  if (!options.json) {
    print_text(plan_text(scene, plan));
    return 0;
  }
  nlohmann::ordered_json json = plan_json(plan);
  json["scene"] = scene.path;
  json["frame"] = frame;
  json["scene_hash"] = scene_hash(scene);
  json["settings"] = settings_json(scene);
  print_output(json_text(json));
  return 0;
}

} // namespace

CommandRun add_plan(CLI::App& app) {
  const auto options = std::make_shared<PlanOptions>();
  options->scene.declare(app);
  app.add_option("-f,--frame", options->frame, "Frame; default: the first on disk")
      ->option_text("N");
  app.add_flag("--json", options->json, "Print JSON, with all settings");
  app.footer(R"(Examples:
  vdbeam plan cloud.toml
  vdbeam plan smoke.toml -f 7 --json
  vdbeam plan cloud.vdb --estimator path)");
  return [options] { return run_plan(*options); };
}

} // namespace vdbeam::cli
