#include "cli/commands.h"
#include "cli/scene_options.h"
#include "console/streams.h"
#include "keys/estimator_kind.h"
#include "machine/memory.h"
#include "report/plan_text.h"
#include "report/report.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/memory_plan.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

namespace vdbeam::cli {
namespace {

struct PlanOptions {
  SceneOptions scene;
  std::optional<int> frame;
  bool json = false, no_pilot = false;
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

nlohmann::ordered_json memory_json(const MemoryPlan& memory) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::object();
  for (const PlannedMemory& part : memory.parts)
    parts[part.name] = {
        {"reading", part.reading}, {"rendering", part.rendering}, {"writing", part.writing}};
  return {{"parts", parts},
          {"reading", memory.reading},
          {"rendering", memory.rendering},
          {"writing", memory.writing},
          {"peak", memory.peak()}};
}

/// Table of the memory of each part in each phase, and the sums.
std::string memory_text(const MemoryPlan& plan) {
  const auto row = [](const std::string& name, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    const auto text = [](std::uint64_t n) {
      return n > 0 ? format_bytes(static_cast<double>(n)) : std::string("-");
    };
    return fmt::format("  {:<18} {:>10} {:>10} {:>10}\n", name, text(a), text(b), text(c));
  };
  std::string text = fmt::format("\n{:<20} {:>10} {:>10} {:>10}\n", "memory, about", "reading",
                                 "rendering", "writing");
  for (const PlannedMemory& part : plan.parts)
    text += row(part.name, part.reading, part.rendering, part.writing);
  text += row("all", plan.reading, plan.rendering, plan.writing);
  return text + fmt::format("  {:<18} {}\n", "TOTAL (peak)",
                            format_bytes(static_cast<double>(plan.peak())));
}

/// The parts of the method with what was chosen; nothing where no pilot ran.
std::string features_table(const RenderPlan& plan) {
  std::string text;
  for (const bool on : {true, false}) {
    std::string rows;
    for (const FeatureChoice& feature : plan.features)
      if (feature.on == on)
        rows += fmt::format(
            "  {:<20} {}{}{}\n", feature.name, feature.reason,
            feature.scope.empty() ? "" : (on ? "; not for " : "; off for ") + feature.scope,
            feature.cost.empty() ? "" : "; " + feature.cost);
    if (!rows.empty())
      text += fmt::format("\n{}\n{}", on ? "features" : "features that are off", rows);
  }
  return text;
}

/// The numbers of the passes with their origin; nothing where no pilot ran.
std::string numbers_table(const RenderPlan& plan) {
  std::string text;
  for (const PlanNumber& number : plan.numbers)
    text += fmt::format("{}  {:<26} {:<14} {:<10} {}\n", text.empty() ? "\nnumbers\n" : "",
                        number.name, range_text(number), origin_name(number.origin), number.reason);
  return text;
}

/// A column of the table of passes.
struct ScheduleColumn {
  std::string_view name;
  int width;                        ///< [characters]
  double (*value)(const PassSpec&); ///< below 0: none
  bool may_be_zero = false;         ///< else 0 means that there is none
};

constexpr ScheduleColumn schedule_columns[] = {
    {"peak order", 12, [](const PassSpec& spec) { return static_cast<double>(spec.peak_order); }},
    {"kernels", 12,
     [](const PassSpec& spec) {
       return spec.light_paths > 0 ? static_cast<double>(spec.kernel_scale) : 0;
     }},
    {"neighbours", 12, [](const PassSpec& spec) { return spec.neighbours; }},
    {"light paths", 12, [](const PassSpec& spec) { return static_cast<double>(spec.light_paths); }},
    {"walks", 8, [](const PassSpec& spec) { return static_cast<double>(spec.gather_walks); }},
    {"fit [pixels]", 14,
     [](const PassSpec& spec) { return static_cast<double>(spec.regression_radius); }},
    {"of surfaces", 13,
     [](const PassSpec& spec) { return static_cast<double>(spec.surface_fit_radius); }},
    {"motion sample", 15,
     [](const PassSpec& spec) { return static_cast<double>(spec.motion_sample); }, true}};

/// Table of the passes, without columns that are empty; nothing if no pilot ran.
std::string schedule_text(const RenderPlan& plan) {
  if (plan.schedule.empty())
    return {};
  const auto cell = [](const ScheduleColumn& column, const PassSpec& spec) {
    const double number = column.value(spec);
    const bool is_there = column.may_be_zero ? number >= 0 : number > 0;
    if (!is_there)
      return std::string("-");
    return number >= 1000 ? fmt::format("{:.0f}", number) : fmt::format("{:.3g}", number);
  };
  std::vector<const ScheduleColumn*> columns;
  for (const ScheduleColumn& column : schedule_columns)
    if (std::any_of(plan.schedule.begin(), plan.schedule.end(),
                    [&](const PassSpec& spec) { return cell(column, spec) != "-"; }))
      columns.push_back(&column);
  std::string text = fmt::format("\n{:<8}{:<10}", "pass", "estimator");
  for (const ScheduleColumn* column : columns)
    text += fmt::format("{:>{}}", column->name, column->width);
  for (const PassSpec& spec : plan.schedule) {
    text += fmt::format("\n  {:<6}{:<10}", spec.pass, spec.estimator);
    for (const ScheduleColumn* column : columns)
      text += fmt::format("{:>{}}", cell(*column, spec), column->width);
  }
  return text + "\n";
}

std::string plan_text(const Scene& scene, const RenderPlan& plan, const MemoryPlan& memory) {
  std::string text = fmt::format("{}\n\nestimator\n  {:<18} {}\n", scene.path, plan.estimator,
                                 estimator_kind({plan.estimator}).help);
  if (!plan.choice.empty())
    text += fmt::format("  {:<18} {}\n", "chosen", plan.choice);
  for (const bool needed : {true, false}) {
    text += fmt::format("\n{}\n", needed ? "stages" : "left out");
    for (const PlanStage& stage : plan.stages)
      if (stage.needed == needed)
        text += fmt::format("  {:<18} {}\n", stage_name(stage.stage), stage.reason);
  }
  return text + features_table(plan) + numbers_table(plan) + schedule_text(plan) +
         memory_text(memory) + surfaces_text(plan);
}

int run_plan(const PlanOptions& options) {
  const SceneDocument document = options.scene.open();
  const int frame = choose_frame(options.frame, document);
  const Scene scene = document.scene_at(frame);
  for (const std::string& note : scene.notes)
    log("note: {}", note);
  RenderPlan plan = make_plan(scene);
  const MemoryPlan memory = plan_memory(scene);
  const bool fits = memory.peak() <= granted_memory();
  if (!options.no_pilot && !fits)
    log("note: the frame does not fit into this machine's memory, so volumes were not read; "
        "features, numbers and schedule are omitted");
  if (!options.no_pilot && fits) {
    RenderPlan chosen = choose_plan(scene);
    plan.estimator = chosen.estimator;
    plan.choice = std::move(chosen.choice);
    plan.stages = std::move(chosen.stages);
    plan.features = std::move(chosen.features);
    plan.schedule = std::move(chosen.schedule);
    plan.numbers = std::move(chosen.numbers);
  }
  if (!options.json) {
    print_text(plan_text(scene, plan, memory));
    return 0;
  }
  nlohmann::ordered_json json = plan_json(plan);
  json["memory"] = memory_json(memory);
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
  app.add_option("-f,--frame", options->frame, "Frame number; default: the first on disk")
      ->option_text("N");
  app.add_flag("--no-pilot", options->no_pilot,
               "Run no pilots and read no large volumes: omit features, numbers and schedule");
  app.add_flag("--json", options->json, "Print JSON, with all settings");
  app.footer(R"(Examples:
  vdbeam plan cloud.toml
  vdbeam plan smoke.toml -f 7 --json
  vdbeam plan cloud.vdb --estimator path)");
  return [options] { return run_plan(*options); };
}

} // namespace vdbeam::cli
