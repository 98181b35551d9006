#include "text/missing_file.h"

#include "text/frame_range.h"
#include "text/text.h"

#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <vector>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  constexpr std::size_t most = 10'000; // a network share may hold millions
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end && names.size() < most;
       it.increment(error))
    names.push_back(it->path().filename().string());
  return names;
}

/// "smoke.####.vdb, frames 1-24" for a name like smoke.*.vdb, smoke.<UDIM>.vdb or smoke.##.vdb
/// where the folder has files with a number in that place; empty otherwise.
std::string sequence_beside(const fs::path& path, const std::vector<std::string>& names) {
  const std::string name = path.filename().string();
  const std::string token = first_token(name);
  if (token.empty())
    return {};
  const std::size_t begin = name.find(token);
  const std::string before = name.substr(0, begin), after = name.substr(begin + token.size());
  std::set<std::string> patterns;
  for (const std::string& candidate : names) {
    if (candidate.size() <= before.size() + after.size() || !candidate.starts_with(before) ||
        !candidate.ends_with(after))
      continue;
    const std::string middle =
        candidate.substr(before.size(), candidate.size() - before.size() - after.size());
    if (middle.find_first_not_of("0123456789") == std::string::npos)
      patterns.insert(frame_pattern_of(candidate));
  }
  if (patterns.size() != 1)
    return {};
  const std::string& pattern = *patterns.begin();
  return fmt::format("{}, frames {}", pattern,
                     format_frame_range(frames_on_disk((path.parent_path() / pattern).string())));
}

/// The file of the same kind whose name is nearest.
std::string name_beside(const fs::path& path, const std::vector<std::string>& names) {
  std::vector<std::string> stems;
  for (const std::string& name : names)
    if (fs::path(name).extension() == path.extension())
      stems.push_back(fs::path(name).stem().string());
  const auto near = nearest_word(path.stem().string(), stems);
  return near ? *near + path.extension().string() : "";
}

} // namespace

std::string unexpanded_hint(const std::string& path) {
  const std::size_t dollar = path.find('$');
  std::string word = path.starts_with("~") ? path.substr(0, path.find('/')) : "";
  if (word.empty() && dollar != std::string::npos && !has_frame_pattern(path.substr(dollar)))
    word = path.substr(dollar, path.find('/', dollar) - dollar);
  return word.empty() ? ""
                      : fmt::format("; {} is not expanded: write out the path", one_line(word));
}

std::string missing_file_text(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  const std::string text =
      "there is no file " + one_line((error ? fs::path(path) : whole).string());
  for (const fs::path& part : fs::path(path))
    if (const std::string hint = unexpanded_hint(part.string()); !hint.empty())
      return text + hint;
  const fs::path folder = whole.parent_path();
  if (!fs::is_directory(folder, error))
    return text + ", nor its folder";
  const std::vector<std::string> names = names_in(folder);
  if (const std::string sequence = sequence_beside(whole, names); !sequence.empty())
    return fmt::format("{}; there is {}", text, one_line(sequence));
  const std::string near = name_beside(whole, names);
  return near.empty() ? text : fmt::format("{}; did you mean {}?", text, one_line(near));
}

} // namespace vdbeam
