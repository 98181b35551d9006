#include "batch/file_claims.h"

#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <sys/stat.h>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;

const std::string standard_output = "-";

/// Where a link leads that leads to no file yet; a path that is no link is returned as it is.
fs::path behind_links(fs::path path) {
  constexpr int most_links = 40; // as the kernel has it
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(path, error); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error)
      break;
    path = path.parent_path() / target; // an absolute target replaces the folder
  }
  return path;
}

} // namespace

/// Files of a sequence share their folder. To list it once costs less than to ask for each of many.
FileClaims::Folder& FileClaims::folder_of(const std::string& path) {
  constexpr std::size_t often = 256;
  const auto [found, is_new] = folders_.try_emplace(path);
  Folder& folder = found->second;
  std::error_code error;
  if (is_new)
    folder.real = fs::weakly_canonical(path.empty() ? "." : path, error).string();
  if (++folder.asked == often)
    for (fs::directory_iterator it(folder.real, error), end; !error && it != end;
         it.increment(error))
      folder.names.insert(lower_case(it->path().filename().string()));
  if (error) // its files are asked for one by one
    folder.asked = 1;
  folder.listed = folder.asked >= often;
  return folder;
}

std::string FileClaims::identity(const std::string& path) {
  const fs::path given = path;
  const Folder& folder = folder_of(given.parent_path().string());
  const std::string name = lower_case(given.filename().string());
  if (folder.listed && !folder.names.contains(name))
    return folder.real + "/" + name;
  struct stat status {};
  if (stat(path.c_str(), &status) == 0)
    return fmt::format("{}:{}", status.st_dev, status.st_ino);
  const fs::path file = behind_links(path);
  return folder_of(file.parent_path().string()).real + "/" + lower_case(file.filename().string());
}

void FileClaims::claim(const Claim& claim) {
  const bool to_stdout = claim.output && claim.path == standard_output;
  const auto [found, is_new] =
      claims_.try_emplace(to_stdout ? standard_output : identity(claim.path), claim);
  const Claim& other = found->second;
  if (is_new || (!claim.output && !other.output))
    return;
  if (to_stdout)
    throw InputError(fmt::format("{} -: {} is written to the standard output as well; give one of "
                                 "them a file",
                                 claim.name, other.name));
  const Claim& output = claim.output ? claim : other;
  const Claim& rest = claim.output ? other : claim;
  throw InputError(one_line(fmt::format("{} {}: is the same file as {} {}; give another name",
                                        output.name, output.path, rest.name, rest.path)));
}

void FileClaims::input(const std::string& name, const std::string& path) {
  if (!path.empty())
    claim({name, path, false});
}

void FileClaims::output(const std::string& option, const std::string& path) {
  if (!path.empty())
    claim({option, path, true});
}

void FileClaims::inputs(const std::string& name, const std::string& pattern,
                        const std::vector<int>& frames) {
  if (!has_frame_pattern(pattern))
    return input(name, pattern);
  for (const int frame : frames)
    input(name, substitute_frame(pattern, frame));
}

void FileClaims::outputs(const std::string& option, const std::string& pattern,
                         const std::vector<int>& frames) {
  if (!has_frame_pattern(pattern))
    return output(option, pattern);
  for (const int frame : frames)
    output(option, substitute_frame(pattern, frame));
}

void FileClaims::scene(const SceneDocument& document, const std::string& path,
                       const std::vector<int>& frames) {
  input("the scene", path);
  for (const SceneFile& file : document.files()) {
    scene_file(file, frames);
    if (has_frame_pattern(file.pattern))
      scene_file(file, frames_on_disk(file.pattern));
  }
  if (const char* configuration = std::getenv("OCIO"))
    input("OCIO", configuration);
}

/// With the files that it names in turn.
void FileClaims::scene_file(const SceneFile& file, const std::vector<int>& frames) {
  inputs(file.key, file.pattern, frames);
  std::set<std::string> paths;
  for (const int frame : frames)
    paths.insert(substitute_frame(file.pattern, frame));
  for (const std::string& path : paths)
    for (const std::string& named : files_named_by(file.input, path))
      input(fmt::format("what {} names, the file", file.key), named);
}

void FileClaims::render(const FrameFiles& files, const std::vector<int>& frames,
                        const std::string& whose) {
  std::vector<Output> all;
  for (const OutputKind& kind : output_kinds())
    all.push_back(kind.output);
  outputs_of(files, all, frames, whose);
}

void FileClaims::outputs_of(const FrameFiles& files, const std::vector<Output>& wanted,
                            const std::vector<int>& frames, const std::string& whose) {
  for (const OutputKind& kind : output_kinds())
    if (std::find(wanted.begin(), wanted.end(), kind.output) != wanted.end())
      outputs(whose + kind.name, kind.pattern(files), frames);
}

} // namespace vdbeam::cli
