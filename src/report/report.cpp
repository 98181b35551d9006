#include "report/report.h"

#include "keys/scene_keys.h"
#include "machine/atomic_file.h"
#include "machine/cpu.h"
#include "machine/threads.h"
#include "report/versions.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/info.h>

namespace vdbeam {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json value_json(const SceneKey& key, const KeyValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value))
    return key.kind == KeyKind::boolean ? Json(*whole != 0) : Json(*whole);
  if (const auto* real = std::get_if<double>(&value))
    return number(*real);
  if (const auto* text = std::get_if<std::string>(&value))
    return *text;
  if (const auto* list = std::get_if<std::vector<double>>(&value)) {
    Json array = Json::array();
    for (const double x : *list) // colours are floats: give the decimal that was meant
      array.push_back(key.kind == KeyKind::color && std::isfinite(x)
                          ? Json(std::stod(fmt::format("{}", static_cast<float>(x))))
                          : number(x));
    return array;
  }
  return nullptr;
}

Json passes_json(const RenderResult& result) {
  Json list = Json::array();
  for (const PassRecord& pass : result.passes) {
    Json entry{{"pass", pass.pass},
               {"seconds", pass.seconds},
               {"photons", pass.photons},
               {"error_estimate", number(pass.error_estimate)},
               {"error_low", number(pass.error_low)},
               {"error_high", number(pass.error_high)},
               {"noise_estimate", number(pass.noise_estimate)},
               {"bias_mrse_estimate", number(pass.bias_mrse_estimate)},
               {"bias_estimate", number(pass.bias_estimate)},
               {"bias_margin", number(pass.bias_margin)}};
    if (pass.has_reference) {
      entry["rmse"] = number(pass.rmse);
      entry["mrse"] = number(pass.mrse);
      entry["relmse"] = number(pass.relmse);
      entry["bias"] = number(pass.bias);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json machine_json(const Scene& scene) {
  const int cores = tbb::info::default_concurrency();
  return {{"cpu", cpu_model()}, {"cores", cores}, {"threads", thread_count(scene.render)}};
}

} // namespace

Json stage_seconds_json(const RenderStatistics& s) {
  return {{"read", s.read},       {"prepare", s.prepare}, {"build", s.build}, {"pilot", s.pilot},
          {"trace", s.trace},     {"order", s.order},     {"radii", s.radii}, {"query", s.query},
          {"profile", s.profile}, {"direct", s.direct},   {"path", s.path},   {"bias", s.bias}};
}

Json settings_json(const Scene& scene) {
  Json settings = Json::object();
  settings["volume"] = Json::array();
  settings["light"] = Json::array();
  for (const SceneKey& key : scene_keys()) {
    if (!key.get)
      continue;
    for (std::size_t i = 0; i < section_count(scene, key.section); ++i) {
      const Json value = value_json(key, key.get(scene, i));
      if (key.section == SceneSection::phase)
        settings["volume"][i]["phase"][key.name] = value;
      else if (key.section == SceneSection::emission)
        settings["volume"][i]["emission"][key.name] = value;
      else if (key.is_list_item())
        settings[section_name(key.section)][i][key.name] = value;
      else
        settings[section_name(key.section)][key.name] = value;
    }
  }
  return settings;
}

namespace {

Json features_json(const RenderPlan& plan) {
  Json features = Json::array();
  for (const FeatureChoice& feature : plan.features) {
    Json entry{{"name", feature.name},
               {"key", feature.key},
               {"on", feature.on},
               {"reason", feature.reason}};
    if (!feature.scope.empty())
      entry["scope"] = feature.scope;
    if (!feature.cost.empty())
      entry["cost"] = feature.cost;
    features.push_back(std::move(entry));
  }
  return features;
}

Json numbers_json(const RenderPlan& plan) {
  Json numbers = Json::array();
  for (const PlanNumber& number : plan.numbers)
    numbers.push_back({{"name", number.name},
                       {"key", number.key},
                       {"first", number.first},
                       {"last", number.last},
                       {"origin", origin_name(number.origin)},
                       {"reason", number.reason}});
  return numbers;
}

} // namespace

Json schedule_json(const RenderPlan& plan) {
  Json passes = Json::array();
  for (const PassSpec& spec : plan.schedule)
    passes.push_back({{"pass", spec.pass},
                      {"estimator", spec.estimator},
                      {"peak_order", spec.peak_order},
                      {"kernel_scale", spec.kernel_scale},
                      {"neighbours", spec.neighbours},
                      {"light_paths", spec.light_paths},
                      {"gather_walks", spec.gather_walks},
                      {"regression_radius", spec.regression_radius},
                      {"expected_passes", spec.expected_passes},
                      {"surface_fit_radius", spec.surface_fit_radius},
                      {"wide_surface_fit_radius", spec.wide_surface_fit_radius},
                      {"motion_sample", spec.motion_sample},
                      {"probe_turn", spec.probe_turn}});
  return passes;
}

Json plan_json(const RenderPlan& plan) {
  Json stages = Json::array();
  for (const PlanStage& stage : plan.stages)
    stages.push_back(
        {{"name", stage_name(stage.stage)}, {"needed", stage.needed}, {"reason", stage.reason}});
  return {{"estimator", plan.estimator},
          {"choice", plan.choice},
          {"stages", std::move(stages)},
          {"features", features_json(plan)},
          {"schedule", schedule_json(plan)},
          {"numbers", numbers_json(plan)},
          {"memory",
           {{"photons", plan.photon_bytes},
            {"film", plan.film_bytes},
            {"surfaces", plan.surface_bytes},
            {"deep", plan.deep_bytes}}}};
}

namespace {

Json counts_json(const RenderStatistics& statistics) {
  return {{"light_paths", statistics.light_paths},
          {"light_collisions", statistics.light_collisions},
          {"photons_stored", statistics.photons_stored},
          {"contributions", statistics.contributions},
          {"lookups", statistics.lookups},
          {"camera_rays", statistics.camera_rays},
          {"depth_profiles", statistics.depth_profiles},
          {"shadow_rays", statistics.shadow_rays},
          {"emission_rays", statistics.emission_rays},
          {"camera_walks", statistics.camera_walks},
          {"walk_collisions", statistics.walk_collisions},
          {"walk_shadow_rays", statistics.walk_shadow_rays},
          {"gather_walks", statistics.gather_walks},
          {"bias_rays", statistics.bias_rays},
          {"neighbourhoods", statistics.neighbourhoods},
          {"importance_rays", statistics.importance_rays},
          {"pilot_paths", statistics.pilot_paths},
          {"directions", statistics.directions},
          {"maps_reused", statistics.maps_reused},
          {"grids_read", statistics.grids_read},
          {"meshes_read", statistics.meshes_read},
          {"textures_read", statistics.textures_read},
          {"trees_built", statistics.trees_built}};
}

} // namespace

Json report_json(const Scene& scene, const RenderResult& result, const ReportContext& context) {
  const RenderStatistics& statistics = result.statistics;
  Json report;
  for (const auto& [name, version] : component_versions())
    report["versions"][name] = version;
  report["scene"] = scene.path;
  report["scene_hash"] = context.scene_hash;
  report["frame"] = scene.frame.number;
  report["output"] = context.output;
  if (!context.reference.empty())
    report["reference"] = context.reference;
  if (!context.second_reference.empty())
    report["second_reference"] = context.second_reference;
  report["machine"] = machine_json(scene);
  report["settings"] = settings_json(scene);
  report["notes"] = scene.notes;
  for (const std::string& note : result.notes)
    report["notes"].push_back(note);
  report["plan"] = plan_json(result.plan);
  report["seconds"] = stage_seconds_json(statistics);
  report["seconds"]["write"] = statistics.write;
  report["seconds"]["render"] = result.passes.empty() ? 0 : result.passes.back().seconds;
  report["peak_memory"] = statistics.peak_memory;
  report["bytes_per_photon"] = statistics.bytes_per_photon;
  report["neighbours"] = statistics.neighbours;
  report["counts"] = counts_json(statistics);
  if (scene.render.clamp) {
    Json& clamp = report["clamp"];
    clamp["limit"] = *scene.render.clamp;
    clamp["removed_fraction"] = statistics.clamped_fraction();
    clamp["pixels"] = statistics.clamped_pixels;
  }
  if (result.deep)
    report["deep"] = {{"samples", result.deep->z.size()},
                      {"bytes", context.deep_bytes},
                      {"alpha_error", number(static_cast<double>(result.deep->alpha_error))}};
  report["picture"] = {{"optical_depth", number(result.picture.optical_depth)},
                       {"opacity", number(result.picture.opacity)},
                       {"black", number(result.picture.black)},
                       {"over_one", number(result.picture.over_one)}};
  report["stopped_by"] = result.stopped_by;
  report["quick_look"] = result.quick_look;
  report["draft"] = result.draft;
  report["resumed_passes"] = result.resumed_passes;
  report["passes"] = passes_json(result);
  return report;
}

std::string json_text(const Json& json) {
  // Paths may hold bytes that are not UTF-8; they must not cost the report.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_json(const Json& json, const std::string& path) {
  const std::string text = json_text(json);
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

} // namespace vdbeam
