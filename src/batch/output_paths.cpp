#include "batch/output_paths.h"

#include "batch/folder_names.h"
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
#include <optional>
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

void check_replaceable(const std::string& option, const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    fail(option, path, "is not a regular file");
}

/// Checks the paths of a sequence: what is true of a folder is asked for once.
class PathCheck {
public:
  explicit PathCheck(std::string option) : option_(std::move(option)) {}

  /// A path that is given to an option.
  void check(const std::string& path) {
    check_length(path);
    const SplitPath split(path);
    const FolderNames::Folder& folder = names_.of(split.folder);
    const bool may_be_there = folder.may_hold(lower_case(std::string(split.name)));
    std::error_code error;
    if (split.name.empty() || (may_be_there && fs::is_directory(path, error)))
      fail(option_, path, "is a folder; add a file's name");
    check_folder(path, std::string(split.folder));
    if (may_be_there)
      check_replaceable(option_, path);
  }
  /// A path beside one that was checked.
  void check_beside(const std::string& path) {
    check_length(path);
    const SplitPath split(path);
    if (names_.of(split.folder).may_hold(lower_case(std::string(split.name))))
      check_replaceable(option_, path);
  }

private:
  /// On most file systems a name may have 255 bytes and a whole path 4095. The name of the
  /// temporary file, at most 240 bytes long, is a part of the path.
  void check_length(const std::string& path) {
    const SplitPath split(path);
    if (measured_ != split.folder) {
      measured_ = split.folder;
      const long most = ::pathconf(measured_->empty() ? "." : measured_->c_str(), _PC_NAME_MAX);
      longest_name_ = most > 0 ? static_cast<std::size_t>(most) : NAME_MAX;
    }
    if (split.name.size() > longest_name_)
      throw InputError(fmt::format("{}: a name of {} bytes is too long, {} are possible here; "
                                   "choose a shorter one",
                                   option_, split.name.size(), longest_name_));
    constexpr std::size_t temporary_name = 240;
    if (std::max(path.size(), split.folder.size() + temporary_name) >= PATH_MAX)
      throw InputError(fmt::format("{}: a path of {} bytes is too long; choose a shorter one",
                                   option_, path.size()));
  }
  void check_folder(const std::string& path, const std::string& name) {
    if (sound_ == name)
      return;
    const std::string folder = name.empty() ? "." : name;
    std::error_code error;
    if (!fs::exists(folder, error))
      fail(option_, path,
           unexpanded_hint(folder).empty()
               ? fmt::format("there is no folder {0}; make it with: mkdir -p {0}", folder)
               : fmt::format("there is no folder {}{}", folder, unexpanded_hint(folder)));
    if (!fs::is_directory(folder, error))
      fail(option_, path, fmt::format("{} is not a folder", folder));
    if (access(folder.c_str(), W_OK | X_OK) != 0)
      fail(option_, path,
           fmt::format("no permission to write into {}; choose another folder", folder));
    sound_ = name;
  }

  std::string option_;
  FolderNames names_;
  std::optional<std::string> measured_, sound_; ///< the folders that were asked about last
  std::size_t longest_name_ = 0;
};

/// "page//" becomes "page".
std::string without_slashes(std::string path) {
  while (path.size() > 1 && path.back() == '/')
    path.pop_back();
  return path;
}

/// A folder that the program makes where it is missing; its parent must be there.
void check_output_folder(const std::string& option, const std::string& folder) {
  if (has_frame_pattern(folder))
    fail(option, folder,
         "one page shows all frames; name a folder without a place for the frame number");
  std::error_code error;
  const fs::path name = fs::path(without_slashes(folder)).filename();
  if (name.extension() == ".html" && !fs::is_directory(folder, error))
    fail(option, folder,
         fmt::format("name a folder, e.g. {}; the page is index.html in it", name.stem().string()));
  if (!fs::exists(folder, error))
    PathCheck(option).check(without_slashes(folder));
  else if (!fs::is_directory(folder, error))
    fail(option, folder, "is not a folder");
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
  PathCheck check(option);
  if (!has_frame_pattern(path))
    return check.check(path);
  for (const int frame : frames)
    check.check(substitute_frame(path, frame));
}

void check_output_paths(const FrameFiles& files, const std::vector<int>& frames) {
  if (!files.html.empty())
    check_output_folder("--html", files.html);
  for (const OutputKind& kind : output_kinds()) {
    const std::string pattern = kind.pattern(files);
    if (pattern.empty() || (kind.is_text && is_stdout(pattern)))
      continue;
    std::error_code error;
    if (*kind.in_folder != '\0' && !fs::exists(files.html, error))
      continue; // nothing is in its way
    const std::vector<int>& wanted = kind.of_all_frames ? std::vector{frames.front()} : frames;
    if (!kind.is_side_file()) {
      check_output_path(kind.name, pattern, wanted);
      continue;
    }
    PathCheck check(kind.name); // beside a file that was checked
    for (const int frame : wanted)
      check.check_beside(substitute_frame(pattern, frame));
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
