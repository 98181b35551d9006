#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace vdbeam::cli {

/// The folder and the name of a path, as views of it.
struct SplitPath {
  std::string_view folder, name;

  explicit SplitPath(std::string_view path);
};

/// Which files may be in folders. Files of a sequence share their folder, and to list it once costs
/// less than to ask for each of many.
class FolderNames {
public:
  struct Folder {
    std::string real;                      ///< without links
    std::size_t asked = 0;                 ///< how often
    bool listed = false;                   ///< from then on, once that is often
    std::unordered_set<std::string> names; ///< of its files, in small letters

    /// False where no file has the name, in capital or small letters.
    bool may_hold(const std::string& name_in_small_letters) const {
      return !listed || names.contains(name_in_small_letters);
    }
  };

  /// Empty is the present folder.
  Folder& of(std::string_view folder);

private:
  std::unordered_map<std::string, Folder> folders_;
  std::string last_name_;
  Folder* last_ = nullptr; ///< most paths lie where the one before them does
};

} // namespace vdbeam::cli
