#include "batch/folder_names.h"

#include "text/text.h"

#include <filesystem>
#include <system_error>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;

/// Number of questions about a folder from which on it is listed.
constexpr std::size_t often = 256;

void list(FolderNames::Folder& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder.real, error), end; !error && it != end; it.increment(error))
    folder.names.insert(lower_case(it->path().filename().string()));
  folder.listed = !error; // else its files are asked for one by one
}

} // namespace

SplitPath::SplitPath(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  name = slash == path.npos ? path : path.substr(slash + 1);
  folder = slash == path.npos ? "" : slash == 0 ? "/" : path.substr(0, slash);
}

FolderNames::Folder& FolderNames::of(std::string_view name) {
  if (!last_ || last_name_ != name) {
    const auto [found, is_new] = folders_.try_emplace(std::string(name));
    std::error_code error;
    if (is_new)
      found->second.real =
          fs::weakly_canonical(name.empty() ? "." : std::string(name), error).string();
    last_name_ = name;
    last_ = &found->second;
  }
  if (++last_->asked == often)
    list(*last_);
  return *last_;
}

} // namespace vdbeam::cli
