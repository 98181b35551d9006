#include "batch/batch_origin.h"

#include "farm/farm_job.h"
#include "machine/command_line.h"
#include "machine/cpu.h"
#include "report/versions.h"
#include "text/text.h"

#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/info.h>

namespace vdbeam::cli {

std::string date_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

BatchOrigin this_batch() {
  BatchOrigin origin;
  std::error_code error; // where there is no working folder, relative paths lead nowhere anyway
  origin.folder = std::filesystem::current_path(error).string();
  for (const std::string& word : command_line())
    origin.command += (origin.command.empty() ? "" : " ") + shell_word(word);
  origin.date = date_text();
  origin.cpu = cpu_model();
  origin.cores = tbb::info::default_concurrency();
  origin.versions = component_versions();
  return origin;
}

void add_origin(nlohmann::ordered_json& json, const BatchOrigin& origin) {
  json["folder"] = origin.folder;
  json["command"] = origin.command;
  json["date"] = origin.date;
  json["machine"] = {{"cpu", origin.cpu}, {"cores", origin.cores}};
  json["versions"] = nlohmann::ordered_json::object();
  for (const auto& [name, version] : origin.versions)
    json["versions"][name] = version;
}

std::string machine_text(const BatchOrigin& origin) {
  if (origin.cpu.empty() || origin.cores == 0)
    return origin.cpu;
  return fmt::format("{}, {}", origin.cpu,
                     count_text(static_cast<std::uint64_t>(origin.cores), "core"));
}

std::string versions_text(const BatchOrigin& origin) {
  std::string text;
  for (const auto& [name, version] : origin.versions)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, version);
  return text;
}

} // namespace vdbeam::cli
