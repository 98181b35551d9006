#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vdbeam::cli {

/// Where, when and how a batch ran. Texts are empty where they are unknown.
struct BatchOrigin {
  std::string folder;  ///< absolute; relative paths of the batch start there
  std::string command; ///< as a shell takes it
  std::string date;    ///< UTC, "2026-11-26T20:51:18Z", of when the batch was described
  std::string cpu;     ///< model name
  int cores = 0;       ///< 0: unknown
  std::vector<std::pair<std::string, std::string>> versions; ///< names and versions
};

/// That of this process, now.
BatchOrigin this_batch();

/// "2026-11-26T20:51:18Z", now.
std::string date_text();

/// Adds "folder", "command", "date", "machine" and "versions".
void add_origin(nlohmann::ordered_json& json, const BatchOrigin& origin);

/// "Intel Xeon, 32 cores".
std::string machine_text(const BatchOrigin& origin);

/// "vdbeam 0.1.0, OpenVDB 10.0.1".
std::string versions_text(const BatchOrigin& origin);

} // namespace vdbeam::cli
