#include "batch/output_paths.h"

#include "console/streams.h"
#include "report/report.h"
#include "text/frame_range.h"
#include "text/missing_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <climits>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& option, const std::string& path,
                       const std::string& text) {
  throw InputError(one_line(fmt::format("{} {}: {}", option, path, text)));
}

/// "out.exr" becomes "out.####.exr".
std::string with_pattern(const fs::path& path) {
  fs::path result = path;
  return result.replace_filename(path.stem().string() + ".####" + path.extension().string())
      .string();
}

/// "s.<UDIM>.exr" becomes "s.####.exr", "s.%V.####.exr" becomes "s.####.exr".
std::string without_token(const std::string& path, const std::string& token) {
  std::string result = path;
  const std::size_t at = result.rfind(token);
  result.replace(at, token.size(), has_frame_pattern(path) ? "" : "####");
  if (const std::size_t dots = result.find("..", at > 0 ? at - 1 : 0);
      has_frame_pattern(path) && dots != std::string::npos)
    result.erase(dots, 1);
  return result;
}

/// Names may have 255 bytes on most file systems, whole paths 4095 (of which the temporary file's
/// name, at most 240 bytes long, takes its share).
void check_length(const std::string& option, const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  const long most = ::pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  const std::size_t longest_name = most > 0 ? static_cast<std::size_t>(most) : NAME_MAX;
  const std::size_t name = fs::path(path).filename().string().size();
  if (name > longest_name)
    throw InputError(fmt::format("{}: a name of {} bytes is too long, {} are possible here; choose "
                                 "a shorter one",
                                 option, name, longest_name));
  constexpr std::size_t temporary_name = 240;
  if (std::max(path.size(), folder.size() + temporary_name) >= PATH_MAX)
    throw InputError(fmt::format("{}: a path of {} bytes is too long; choose a shorter one", option,
                                 path.size()));
}

void check_replaceable(const std::string& option, const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    fail(option, path, "is not a regular file");
}

void check_one(const std::string& option, const std::string& name) {
  check_length(option, name);
  std::error_code error;
  const fs::path path(name);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (path.filename().empty() || fs::is_directory(path, error))
    fail(option, name, "is a folder; add a file's name");
  if (!fs::exists(folder, error))
    fail(option, name,
         unexpanded_hint(folder.string()).empty()
             ? fmt::format("there is no folder {0}; make it with: mkdir -p {0}", folder.string())
             : fmt::format("there is no folder {}{}", folder.string(),
                           unexpanded_hint(folder.string())));
  if (!fs::is_directory(folder, error))
    fail(option, name, fmt::format("{} is not a folder", folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    fail(option, name,
         fmt::format("no permission to write into {}; choose another folder", folder.string()));
  check_replaceable(option, name);
}

} // namespace

void check_output_path(const std::string& option, const std::string& path,
                       const std::vector<int>& frames) {
  if (path.empty())
    return;
  if (const std::string token = foreign_token(path); !token.empty())
    fail(option, path,
         fmt::format("{} does not stand for the frame number; write {}", token,
                     without_token(path, token)));
  if (frames.size() > 1 && !has_frame_pattern(path))
    fail(
        option, path,
        fmt::format("{} frames would go to one file; write {}", frames.size(), with_pattern(path)));
  for (const int frame : frames)
    check_one(option, substitute_frame(path, frame));
}

void check_output_paths(const FrameFiles& files, const std::vector<int>& frames) {
  for (const OutputKind& kind : output_kinds()) {
    const std::string pattern = kind.pattern(files);
    if (pattern.empty() || (kind.is_text && is_stdout(pattern)))
      continue;
    if (!kind.is_side_file())
      check_output_path(kind.name, pattern,
                        kind.of_all_frames ? std::vector{frames.front()} : frames);
    else // beside a file that was checked
      for (const int frame : frames) {
        check_length(kind.name, output_path(files, kind.output, frame));
        check_replaceable(kind.name, output_path(files, kind.output, frame));
      }
  }
}

bool is_stdout(const std::string& path) {
  return path == "-";
}

void write_json_output(const nlohmann::ordered_json& json, const std::string& path) {
  if (is_stdout(path))
    write_stdout(json_text(json));
  else
    write_json(json, path);
}

} // namespace vdbeam::cli
