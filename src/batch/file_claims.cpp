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

std::string FileClaims::identity(const std::string& path) {
  const SplitPath given(path);
  const FolderNames::Folder& folder = folders_.of(given.folder);
  const std::string name = lower_case(std::string(given.name));
  if (!folder.may_hold(name))
    return folder.real + "/" + name;
  struct stat status {};
  if (stat(path.c_str(), &status) == 0)
    return fmt::format("{}:{}", status.st_dev, status.st_ino);
  const std::string file = behind_links(path).string();
  const SplitPath target(file);
  return folders_.of(target.folder).real + "/" + lower_case(std::string(target.name));
}

std::string FileClaims::Claim::path() const {
  return frame ? substitute_frame(*pattern, *frame) : *pattern;
}

const std::string* FileClaims::keep(const std::string& text) {
  return &texts_.emplace_back(text);
}

/// More places than claims will need for some time.
void FileClaims::make_slots() {
  constexpr std::size_t fewest = 64;
  slots_.assign(std::max(fewest, 4 * slots_.size()), 0);
  for (std::size_t i = 0; i < hashes_.size(); ++i) {
    std::size_t slot = hashes_[i] % slots_.size();
    while (slots_[slot] != 0)
      slot = (slot + 1) % slots_.size();
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

const FileClaims::Claim& FileClaims::first_claim(const std::string& identity, const Claim& claim) {
  if (2 * (claims_.size() + 1) > slots_.size())
    make_slots();
  const std::size_t hash = std::hash<std::string>()(identity);
  std::size_t slot = hash % slots_.size();
  for (; slots_[slot] != 0; slot = (slot + 1) % slots_.size()) {
    const std::size_t i = slots_[slot] - 1;
    if (hashes_[i] == hash && identity_of(claims_[i]) == identity)
      return claims_[i];
  }
  claims_.push_back(claim);
  hashes_.push_back(hash);
  slots_[slot] = static_cast<std::uint32_t>(claims_.size());
  return claims_.back();
}

std::string FileClaims::identity_of(const Claim& claim) {
  const std::string path = claim.path();
  return claim.output && path == standard_output ? path : identity(path);
}

void FileClaims::claim(const Claim& claim) {
  const std::size_t before = claims_.size();
  const Claim other = first_claim(identity_of(claim), claim);
  if (claims_.size() > before || (!claim.output && !other.output))
    return;
  const bool to_stdout = claim.output && claim.path() == standard_output;
  if (to_stdout)
    throw InputError(
        fmt::format("{} -: {} also writes to the standard output; give one of them a file",
                    *claim.name, *other.name));
  const Claim& output = claim.output ? claim : other;
  const Claim& rest = claim.output ? other : claim;
  throw InputError(one_line(fmt::format("{} {}: is the same file as {} {}; give another name",
                                        *output.name, output.path(), *rest.name, rest.path())));
}

void FileClaims::input(const std::string& name, const std::string& path) {
  if (!path.empty())
    claim({keep(name), keep(path), std::nullopt, false});
}

void FileClaims::output(const std::string& option, const std::string& path) {
  if (!path.empty())
    claim({keep(option), keep(path), std::nullopt, true});
}

/// The path of each frame; a pattern without a frame's place is one path.
void FileClaims::claim_all(const std::string& name, const std::string& pattern,
                           const std::vector<int>& frames, bool output) {
  if (pattern.empty())
    return;
  const std::string *kept_name = keep(name), *kept_pattern = keep(pattern);
  if (!has_frame_pattern(pattern))
    return claim({kept_name, kept_pattern, std::nullopt, output});
  for (const int frame : frames)
    claim({kept_name, kept_pattern, frame, output});
}

void FileClaims::inputs(const std::string& name, const std::string& pattern,
                        const std::vector<int>& frames) {
  claim_all(name, pattern, frames, false);
}

void FileClaims::outputs(const std::string& option, const std::string& pattern,
                         const std::vector<int>& frames) {
  claim_all(option, pattern, frames, true);
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
      outputs(whose + kind.name, kind.pattern(files),
              kind.of_all_frames ? std::vector{frames.front()} : frames);
}

} // namespace vdbeam::cli
