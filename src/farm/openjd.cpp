#include "farm/engines.h"
#include "farm/job_seal.h"
#include "farm/openjd_range.h"
#include "vdbeam/error.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vdbeam {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Longest value of a parameter, longest name of a job.
constexpr std::size_t value_limit = 1024, name_limit = 128;

/// Text that stands in the template as it is: the format has no way to write two braces.
const std::string& literal(const std::string& text) {
  if (text.find("{{") != std::string::npos)
    throw InputError(
        fmt::format("openjd: {}: holds {{{{, which a template cannot; rename it", text));
  if (text.size() > value_limit)
    throw InputError(fmt::format("openjd: {}...: is longer than {} characters", text.substr(0, 60),
                                 value_limit));
  return text;
}

/// The path as seen from the template's folder, or nothing where it is not below it: a template's
/// default paths must be relative.
std::string relative_to_template(const FarmJob& job, const std::string& path) {
  const fs::path file(job.job_file);
  const fs::path base = file.has_parent_path() ? file.parent_path() : fs::path(job.folder);
  const fs::path relative = fs::path(path).lexically_relative(base);
  const std::string text = relative.generic_string();
  return text.starts_with("..") ? "" : text;
}

Json parameter(const std::string& name, const std::string& type, const std::string& description) {
  return {{"name", name}, {"type", type}, {"description", description}};
}

Json folder_parameter(const FarmJob& job, const std::string& name, const std::string& path,
                      const std::string& flow, const std::string& description) {
  Json json = parameter(name, "PATH", description);
  json["objectType"] = "DIRECTORY";
  json["dataFlow"] = flow;
  if (const std::string relative = relative_to_template(job, path); !relative.empty())
    json["default"] = literal(relative);
  return json;
}

Json text_parameter(const std::string& name, const std::string& value,
                    const std::string& description) {
  Json json = parameter(name, "STRING", description);
  json["default"] = literal(value);
  json["minLength"] = 1;
  return json;
}

Json count_parameter(const std::string& name, int value, int least,
                     const std::string& description) {
  Json json = parameter(name, "INT", description);
  json["default"] = value;
  json["minValue"] = least;
  return json;
}

Json parameters(const FarmJob& job) {
  const fs::path scene(job.scene), output(job.output);
  return Json::array(
      {folder_parameter(job, "SceneFolder", scene.parent_path().string(), "IN",
                        "Folder of the scene and its volumes"),
       text_parameter("SceneName", scene.filename().string(), "Scene file or VDB in that folder"),
       text_parameter("Frames", openjd_range(job.frames), "Frames, e.g. 1-24, 1-99:2 or 1,5,9-12"),
       folder_parameter(job, "OutputFolder", output.parent_path().string(), "OUT",
                        "Folder of the images; it must exist"),
       text_parameter("OutputName", output.filename().string(),
                      "Name of the images, with #### for the frame number"),
       count_parameter("FramesPerTask", job.chunk, 1, "Frames of one task"),
       count_parameter("TaskSeconds", 0, 0,
                       "Seconds that a task should take, where the farm chooses its frames; 0: "
                       "always FramesPerTask"),
       text_parameter("Checkpoint", seconds_text(job.checkpoint), "Time between checkpoints"),
       text_parameter("Vdbeam", job.program,
                      "Program on the workers: a name in the PATH or a path")});
}

Json requirements(const FarmJob& job) {
  return {{"amounts",
           {{{"name", "amount.worker.vcpu"}, {"min", job.threads}},
            {{"name", "amount.worker.memory"}, {"min", job.memory_mib}}}},
          {"attributes", {{{"name", "attr.worker.os.family"}, {"anyOf", {"linux"}}}}}};
}

Json frame_space() {
  return {{"taskParameterDefinitions",
           {{{"name", "Frames"},
             {"type", "CHUNK[INT]"},
             {"range", "{{Param.Frames}}"},
             {"chunks",
              {{"defaultTaskCount", "{{Param.FramesPerTask}}"},
               {"targetRuntimeSeconds", "{{Param.TaskSeconds}}"},
               {"rangeConstraint", "NONCONTIGUOUS"}}}}}}};
}

Json render_action(const FarmJob& job) {
  Json args = {"render", "{{Param.SceneFolder}}/{{Param.SceneName}}"};
  for (const std::string& word : job.options)
    args.push_back(literal(word));
  for (const char* word :
       {"--frames={{Task.Param.Frames}}", "-o", "{{Param.OutputFolder}}/{{Param.OutputName}}",
        "--skip-existing", "--checkpoint", "{{Param.Checkpoint}}", "--progress", "openjd"})
    args.push_back(word);
  Json action = {{"command", "{{Param.Vdbeam}}"}, {"args", std::move(args)}};
  if (job.time_limit > 0)
    action["timeout"] = static_cast<int>(std::ceil(job.time_limit));
  // A pass is left within 5 s; the rest is for a slow disk to take the checkpoint.
  action["cancelation"] = {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 60}};
  return action;
}

} // namespace

std::string openjd_submission(const FarmJob& job) {
  const std::string file = job.job_file.empty() ? "FILE" : shell_word(job.job_file);
  std::string text = "openjd run " + file;
  for (const auto& [name, path] :
       {std::pair{"SceneFolder", job.scene}, {"OutputFolder", job.output}}) {
    const std::string folder = fs::path(path).parent_path().string();
    if (relative_to_template(job, folder).empty())
      text += fmt::format(" -p {}", shell_word(fmt::format("{}={}", name, folder)));
  }
  return text;
}

std::string openjd_template(const FarmJob& job) {
  if (job.splits > 1)
    throw InputError("openjd: --splits is for slurm only; use more frames at once, or a region");
  Json json;
  json["specificationVersion"] = "jobtemplate-2023-09";
  json["extensions"] = {"TASK_CHUNKING"};
  json["name"] = literal(job.name.substr(0, name_limit));
  json["description"] = job_mark("openjd");
  json["parameterDefinitions"] = parameters(job);
  Json step;
  step["name"] = "Render";
  step["hostRequirements"] = requirements(job);
  step["parameterSpace"] = frame_space();
  step["script"]["actions"]["onRun"] = render_action(job);
  json["steps"] = Json::array({std::move(step)});
  return sealed_job(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

} // namespace vdbeam
