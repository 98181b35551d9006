#pragma once

#include "report/report.h"
#include "scene/scene_document.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace vdbeam::test {

/// Reads bytes as a scene file; what comes after a zero byte is a --set. Returns what is wrong with
/// how it ended: it must give a scene that can be printed, or an error of one line.
inline std::string read_scene_bytes(std::string_view bytes, const std::string& path) {
  // VDBs go to a child process, which the tests of src/vdb damage.
  if (bytes.starts_with(" BDV"))
    return {};
  const std::size_t zero = bytes.find('\0');
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes.substr(0, zero);
  try {
    std::vector<Override> overrides;
    if (zero != bytes.npos)
      overrides.push_back(parse_override(std::string(bytes.substr(zero + 1))));
    const SceneDocument document(path, overrides);
    document.has_frame_pattern();
    for (const int frame : {1, -7, 1000000})
      settings_json(document.scene_at(frame, MissingFile::black)).dump();
  } catch (const Error& error) {
    const std::string line = error.what();
    if (line.empty() || line.find('\n') != line.npos)
      return "not one line: " + line;
  }
  return {};
}

} // namespace vdbeam::test
